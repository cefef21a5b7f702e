#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/internal/world.h"

namespace lowlap {
namespace {

constexpr std::uint64_t kWallPointStream = 1'000'000;
constexpr std::uint64_t kWallLineStream = 2'000'000;
constexpr std::uint64_t kOffWallStream = 3'000'000;

// The sides of posters, at most this part of the wall's lesser side.
double LargestSide(const Wall& wall) {
  return 0.3 * std::min(wall.u.norm(), wall.v.norm());
}

Vec3 InFrontOf(const Wall& wall, Random* random) {
  const double a = random->Uniform(), b = random->Uniform();
  return wall.At(a, b) +
         wall.clearance * random->Uniform(0.0, 1.0) * wall.inward;
}

// Any direction.
void AddStrewnLine(const Wall& wall, int index, Random* random, World* world) {
  const Vec3 center = InFrontOf(wall, random);
  const double length = random->Uniform(0.25, 1.0) * LargestSide(wall);
  Vec3 direction;
  for (double& component : direction) component = random->Gaussian(1.0);
  const Vec3 half = 0.5 * length * direction.normalized();
  world->lines.push_back({center - half, center + half, index, {}});
}

void AddRuling(const Wall& wall, int index, Random* random, World* world) {
  const double share =
      random->Uniform(0.25, 1.0) * LargestSide(wall) / wall.v.norm();
  const double a = random->Uniform(), low = random->Uniform(0.0, 1.0 - share);
  const Vec3 start = wall.SurfaceAt(a, low);
  world->lines.push_back({start, start + share * wall.v, index, {}});
}

// The four sides of a poster, door or window: mostly upright, some turned.
void AddRectangle(const Wall& wall, int index, int num_sides, Random* random,
                  World* world) {
  const double length_u = wall.u.norm(), length_v = wall.v.norm();
  const double largest = LargestSide(wall);
  const double half_width = 0.5 * random->Uniform(0.25, 1.0) * largest;
  const double half_height = 0.5 * random->Uniform(0.25, 1.0) * largest;
  const double turn =
      RadFromDeg(random->Uniform() < 0.6 ? random->Gaussian(1.0)
                                         : random->Uniform(-45.0, 45.0));
  const Vec3 axis_u = wall.u / length_u;
  const Vec3 axis_v = wall.inward.cross(axis_u);
  const Vec3 a = std::cos(turn) * axis_u + std::sin(turn) * axis_v;
  const Vec3 b = wall.inward.cross(a);
  const double margin = std::hypot(half_width, half_height);
  const double inset_u = std::min(0.5, margin / length_u);
  const double inset_v = std::min(0.5, margin / length_v);
  const double along_u = random->Uniform(inset_u, 1 - inset_u);
  const double along_v = random->Uniform(inset_v, 1 - inset_v);
  const Vec3 center = wall.SurfaceAt(along_u, along_v);
  const int plane =
      wall.HasBoxAt(along_u, along_v) ? wall.box_plane : wall.plane;
  const Vec3 corners[4] = {center - half_width * a - half_height * b,
                           center + half_width * a - half_height * b,
                           center + half_width * a + half_height * b,
                           center - half_width * a + half_height * b};
  for (int side = 0; side < num_sides; ++side) {
    world->lines.push_back(
        {corners[side], corners[(side + 1) % 4], index, {plane}});
  }
}

// Moves the two ends off the wall by different amounts.
void MoveOff(const Wall& wall, Random* random, WorldLine* line) {
  line->start += wall.clearance * random->Uniform(0.15, 1.0) * wall.inward;
  line->end += wall.clearance * random->Uniform(0.15, 1.0) * wall.inward;
  line->planes.clear();
}

}  // namespace

void FillWalls(const SyntheticOptions& options, double off_wall, World* world) {
  const bool is_cloud = options.kind == SyntheticKind::kCloud;
  const int num_walls = static_cast<int>(world->walls.size());
  for (int index = 0; index < num_walls; ++index) {
    const Wall& wall = world->walls[index];
    Random points(options.seed, kWallPointStream + index);
    for (int i = 0; i < options.points_per_wall; ++i) {
      if (is_cloud) {
        world->points.push_back({InFrontOf(wall, &points), index});
        continue;
      }
      const double a = points.Uniform(), b = points.Uniform();
      world->points.push_back({wall.SurfaceAt(a, b), index});
    }
    Random lines(options.seed, kWallLineStream + index);
    for (int left = options.lines_per_wall; left > 0;) {
      if (is_cloud || wall.bulge > 0) {
        const auto add = is_cloud ? AddStrewnLine : AddRuling;
        add(wall, index, &lines, world);
        --left;
      } else {
        AddRectangle(wall, index, std::min(left, 4), &lines, world);
        left -= 4;
      }
    }
  }
  for (std::size_t i = 0; i < world->lines.size(); ++i) {
    WorldLine& line = world->lines[i];
    Random random(options.seed, kOffWallStream + i);
    // An edge would stay on its other wall.
    if (random.Uniform() < off_wall && line.planes.size() == 1) {
      MoveOff(world->walls[line.wall], &random, &line);
    }
  }
}

}  // namespace lowlap
