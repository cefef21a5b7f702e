#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/internal/world.h"

namespace lowlap {
namespace {

// World: x and z horizontal, y down, as in a camera. Several random draws in
// one call are in braces, which fix their order.
constexpr std::uint64_t kLayoutStream = 1;
constexpr std::uint64_t kOffLineStream = 2;

Pose LookAt(const Vec3& center, const Vec3& target, double roll_rad) {
  const Vec3 forward = (target - center).normalized();
  const Vec3 right = Vec3::UnitY().cross(forward).normalized();
  const Vec3 down = forward.cross(right);
  Mat3 upright;
  upright.row(0) = right.transpose();
  upright.row(1) = down.transpose();
  upright.row(2) = forward.transpose();
  Pose pose;
  pose.rotation = RotationFromAngleAxis(Vec3(0, 0, roll_rad)) * upright;
  pose.center = center;
  return pose;
}

// Cameras on a loop are at most 30 degrees apart: few of them cover a part of
// it.
double LoopStep(int num_views) {
  return std::min(2 * kPi / num_views, RadFromDeg(30.0));
}

double Roll(Random* random) { return random->Gaussian(RadFromDeg(2.0)); }

void AddEdge(const Vec3& start, const Vec3& end, int wall_a, int wall_b,
             World* world) {
  world->lines.push_back(
      {start,
       end,
       wall_a,
       {world->walls[wall_a].plane, world->walls[wall_b].plane}});
}

// A box of about 6 x 2.7 x 4.5 m whose walls meet at 80 to 100 degrees and
// whose ceiling slopes, with its twelve edges.
void AddRoom(Random* random, World* world) {
  std::array<Vec3, 4> floor = {Vec3(-3.0, 1.4, -2.25), Vec3(3.0, 1.4, -2.25),
                               Vec3(3.0, 1.4, 2.25), Vec3(-3.0, 1.4, 2.25)};
  for (Vec3& corner : floor) {
    corner.x() += random->Uniform(-0.2, 0.2);
    corner.z() += random->Uniform(-0.2, 0.2);
  }
  const double slope_x = random->Uniform(-0.05, 0.05);
  const double slope_z = random->Uniform(-0.05, 0.05);
  std::array<Vec3, 4> ceiling = floor;
  for (Vec3& corner : ceiling) {
    corner.y() = -1.3 + slope_x * corner.x() + slope_z * corner.z();
  }
  const Vec3 middle(0, 0, 0);
  std::array<int, 4> side;
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    // The lower of the two corners bounds the parallelogram.
    const double height = std::min(floor[i].y() - ceiling[i].y(),
                                   floor[next].y() - ceiling[next].y());
    side[i] = world->AddWall(floor[i], floor[next] - floor[i],
                             Vec3(0, -height, 0), middle, 1.2);
  }
  const int floor_wall = world->AddWall(floor[0], floor[1] - floor[0],
                                        floor[3] - floor[0], middle, 0.8);
  const int ceiling_wall = world->AddWall(ceiling[0], ceiling[1] - ceiling[0],
                                          ceiling[3] - ceiling[0], middle, 0.6);
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    AddEdge(floor[i], floor[next], side[i], floor_wall, world);
    AddEdge(ceiling[i], ceiling[next], side[i], ceiling_wall, world);
    AddEdge(floor[i], ceiling[i], side[i], side[(i + 3) % 4], world);
  }
}

void AddRoomCameras(const SyntheticOptions& options, Random* random,
                    World* world) {
  const int n = options.num_views;
  const double size = options.look_outwards ? 0.4 : 1.0;
  for (int i = 0; i < n; ++i) {
    const double angle = LoopStep(n) * (i + random->Uniform(-0.15, 0.15));
    const Vec3 outward(std::cos(angle), 0, std::sin(angle));
    const double radius = size * random->Uniform(0.9, 1.1);
    const Vec3 center(1.7 * radius * outward.x(), random->Uniform(-0.3, 0.3),
                      1.2 * radius * outward.z());
    const Vec3 forward = options.look_outwards ? outward : Vec3(-outward);
    const Vec3 aim =
        center + 3 * forward + Vec3(0, random->Uniform(-0.2, 0.2), 0);
    world->poses.push_back(LookAt(center, aim, Roll(random)));
  }
}

// A step aside instead of one along the loop.
void MoveTwins(double baseline_m, World* world) {
  for (std::size_t i = 1; i < world->poses.size(); i += 2) {
    const Vec3& before = world->poses[i - 1].center;
    const Vec3 step = world->poses[i].center - before;
    world->poses[i].center = before + baseline_m * step.normalized();
  }
}

// One straight path along the room, all cameras looking at one long wall.
void AddCollinearCameras(const SyntheticOptions& options, Random* random,
                         World* world) {
  const int n = options.num_views;
  const double step = 4.0 / std::max(1, n - 1);
  for (int i = 0; i < n; ++i) {
    const double x = -2.0 + step * (i + random->Uniform(-0.25, 0.25));
    Random off_line(options.seed + i, kOffLineStream);
    const Vec3 across{0, off_line.Gaussian(options.off_line_m),
                      off_line.Gaussian(options.off_line_m)};
    const Vec3 center = Vec3(0, 0.1, -1.4) + x * Vec3(1, 0.05, 0.1) + across;
    const Vec3 aim(0.6 * x, random->Uniform(-0.1, 0.1), 2.25);
    world->poses.push_back(LookAt(center, aim, Roll(random)));
  }
}

// Sections, 2.4 m wide and 2.6 m high; the direction changes slightly from
// section to section: floor and ceiling are one plane each, the side walls are
// not. Where sections look the same it does not change.
void AddCorridor(const SyntheticOptions& options, Random* random,
                 World* world) {
  constexpr double kHalfWidth = 1.2, kStep = 0.8, kTurn_deg = 4.0;
  constexpr int kNumWalls = 4;  // of a section
  const double length = options.section_m;
  const bool is_straight = options.alike_share > 0;
  const int sections =
      static_cast<int>(std::ceil((kStep * options.num_views + 10) / length));
  std::vector<Vec3> axis = {Vec3::Zero()};
  for (int s = 0; s < sections; ++s) {
    const double heading = RadFromDeg(random->Uniform(-kTurn_deg, kTurn_deg));
    const Vec3 along(std::sin(heading), 0, std::cos(heading));
    const Vec3 end =
        axis.back() + length * (is_straight ? Vec3(Vec3::UnitZ()) : along);
    axis.push_back(end);
  }
  for (int s = 0; s < sections; ++s) {
    const Vec3 a = axis[s], along = axis[s + 1] - axis[s];
    const Vec3 right = Vec3::UnitY().cross(along).normalized() * kHalfWidth;
    const Vec3 up(0, -2.6, 0), floor(0, 1.4, 0);
    const Vec3 inside = a + 0.5 * along;
    // Planes of the first section have the indices of its walls.
    const auto plane_of_first = [&](int wall) { return s == 0 ? -1 : wall; };
    const auto side_plane = [&](int wall) {
      return is_straight ? plane_of_first(wall) : -1;
    };
    const int left_wall = world->AddWall(a - right + floor, along, up, inside,
                                         0.7, side_plane(0));
    const int right_wall = world->AddWall(a + right + floor, along, up, inside,
                                          0.7, side_plane(1));
    const int floor_wall = world->AddWall(a - right + floor, along, 2 * right,
                                          inside, 0.7, plane_of_first(2));
    const int ceiling_wall =
        world->AddWall(a - right + floor + up, along, 2 * right, inside, 0.5,
                       plane_of_first(3));
    if (is_straight && s > 0) {
      for (int n = 0; n < kNumWalls; ++n) {
        world->walls[kNumWalls * s + n].alike_wall = n;
      }
    }
    const Vec3 left_low = a - right + floor, right_low = a + right + floor;
    AddEdge(left_low, left_low + along, left_wall, floor_wall, world);
    AddEdge(right_low, right_low + along, right_wall, floor_wall, world);
    AddEdge(left_low + up, left_low + up + along, left_wall, ceiling_wall,
            world);
    AddEdge(right_low + up, right_low + up + along, right_wall, ceiling_wall,
            world);
  }
  for (int i = 0; i < options.num_views; ++i) {
    const double distance = kStep * (i + random->Uniform(-0.2, 0.2)) + 0.4;
    const int s =
        std::clamp(static_cast<int>(distance / length), 0, sections - 1);
    const Vec3 along = (axis[s + 1] - axis[s]) / length;
    const Vec3 right = Vec3::UnitY().cross(along);
    const double sideways = random->Uniform(-0.5, 0.5);
    const double below = random->Uniform(-0.2, 0.2);
    const Vec3 center = axis[s] + (distance - length * s) * along +
                        sideways * right + Vec3(0, below, 0);
    // Slowly from the left wall to the right and back.
    const double yaw = RadFromDeg(30.0) * std::sin(0.4 * i);
    const Vec3 aim =
        center + 3 * (std::cos(yaw) * along + std::sin(yaw) * right);
    world->poses.push_back(LookAt(center, aim, Roll(random)));
  }
  world->max_range = 8.0;
}

// Seven boxes on a floor, their tops and sides; a camera sees the sides that
// face it. One box hiding another is not simulated.
void AddRing(const SyntheticOptions& options, Random* random, World* world) {
  constexpr int kBoxes = 7;
  for (int box = 0; box < kBoxes; ++box) {
    const double around = 2 * kPi * box / kBoxes;
    const double out = box == 0 ? 0.0 : 1.6;
    const Vec3 base{out * std::cos(around) + random->Uniform(-0.1, 0.1), 1.0,
                    out * std::sin(around) + random->Uniform(-0.1, 0.1)};
    const double turn = random->Uniform(0, kPi);
    const Vec3 u =
        random->Uniform(0.7, 1.1) * Vec3(std::cos(turn), 0, std::sin(turn));
    const Vec3 v =
        random->Uniform(0.7, 1.1) * Vec3(-std::sin(turn), 0, std::cos(turn));
    const Vec3 up(0, -random->Uniform(0.6, 1.6), 0);
    const Vec3 corner = base - 0.5 * u - 0.5 * v;
    const Vec3 beyond = 10 * (u + v);
    const double clearance = 0.6;
    world->AddWall(corner, u, up, corner - beyond, clearance);
    world->AddWall(corner, v, up, corner - beyond, clearance);
    world->AddWall(corner + v, u, up, corner + beyond, clearance);
    world->AddWall(corner + u, v, up, corner + beyond, clearance);
    world->AddWall(corner + up, u, v, corner + 10 * up, clearance);
  }
  world->AddWall(Vec3(-3, 1, -3), Vec3(6, 0, 0), Vec3(0, 0, 6), Vec3(0, -5, 0),
                 0.8);
  const int n = options.num_views;
  for (int i = 0; i < n; ++i) {
    const double angle = LoopStep(n) * (i + random->Uniform(-0.15, 0.15));
    const double radius = random->Uniform(3.7, 4.3);
    const Vec3 center(radius * std::cos(angle), random->Uniform(-1.8, -1.2),
                      radius * std::sin(angle));
    const Vec3 aim{random->Uniform(-0.2, 0.2), 0.4, random->Uniform(-0.2, 0.2)};
    world->poses.push_back(LookAt(center, aim, Roll(random)));
  }
}

// Four sides on a parallelogram, which is the half turn of itself; the third
// and the fourth are as the first and the second.
void AddHouse(Random* random, World* world) {
  const auto half_turned = [](const Vec3& p) {
    return Vec3(-p.x(), p.y(), -p.z());
  };
  std::array<Vec3, 4> corner = {Vec3(-4, 1.4, -3), Vec3(4, 1.4, -3)};
  for (int i = 0; i < 2; ++i) {
    corner[i].x() += random->Uniform(-0.3, 0.3);
    corner[i].z() += random->Uniform(-0.3, 0.3);
    corner[i + 2] = half_turned(corner[i]);
  }
  const Vec3 up(0, -4, 0);
  std::array<int, 4> side;
  for (int i = 0; i < 4; ++i) {
    const Vec3 along = corner[(i + 1) % 4] - corner[i];
    const Vec3 middle = corner[i] + 0.5 * along;
    side[i] = world->AddWall(corner[i], along, up, 2 * middle, 0.6);
    if (i >= 2) world->walls[side[i]].alike_wall = side[i - 2];
  }
  for (int i = 0; i < 4; ++i) {
    AddEdge(corner[i], corner[i] + up, side[i], side[(i + 3) % 4], world);
  }
}

void AddHouseCameras(const SyntheticOptions& options, Random* random,
                     World* world) {
  const int n = options.num_views;
  for (int i = 0; i < n; ++i) {
    const double angle = LoopStep(n) * (i + random->Uniform(-0.15, 0.15));
    const double size = random->Uniform(0.9, 1.1);
    const Vec3 center(10 * size * std::cos(angle), random->Uniform(-0.4, 0.4),
                      8.5 * size * std::sin(angle));
    const Vec3 aim{random->Uniform(-1, 1), random->Uniform(-1, 0),
                   random->Uniform(-1, 1)};
    world->poses.push_back(LookAt(center, aim, Roll(random)));
  }
}

void AddBoxes(double offset_m, World* world) {
  const std::size_t num_planes = world->planes.size();
  for (std::size_t n = 0; n < num_planes; ++n) {
    Vec4 front = world->planes[n];
    front.w() -= offset_m;
    world->planes.push_back(front);
  }
  for (Wall& wall : world->walls) {
    wall.box_offset = offset_m;
    wall.box_plane = wall.plane + static_cast<int>(num_planes);
  }
}

// Without planes there are no straight edges either.
void DropPlanes(World* world) {
  world->planes.clear();
  world->lines.clear();
}

// A wall 4 m in front of the cameras, in sections of 4 m.
void AddPlanar(const SyntheticOptions& options, Random* random, World* world) {
  constexpr double kSection = 4.0, kStep = 0.7;
  const Vec3 along = Vec3(1, 0, 0.1).normalized();
  const int n = options.num_views;
  const int sections = static_cast<int>(std::ceil((kStep * n + 6) / kSection));
  int plane = -1;
  for (int s = 0; s < sections; ++s) {
    const Vec3 origin = Vec3(-3, 2, 4) + kSection * s * along;
    const int wall = world->AddWall(origin, kSection * along, Vec3(0.1, -4, 0),
                                    Vec3(0, 0, 0), 1.2, plane);
    plane = world->walls[wall].plane;
  }
  for (int i = 0; i < n; ++i) {
    const double distance = kStep * (i + random->Uniform(-0.2, 0.2));
    const double below = random->Uniform(-0.3, 0.3);
    const double nearer = random->Uniform(-0.5, 0.5);
    const Vec3 center = distance * along + Vec3(0, below, nearer);
    const double sideways = random->Uniform(-1.0, 1.0);
    const Vec3 aim = (distance + sideways) * along + Vec3(0, 0, 4);
    world->poses.push_back(LookAt(center, aim, Roll(random)));
  }
}

}  // namespace

int World::AddWall(const Vec3& origin, const Vec3& u, const Vec3& v,
                   const Vec3& seen_from, double clearance, int plane) {
  Vec3 normal = u.cross(v).normalized();
  if (normal.dot(seen_from - origin) < 0) normal = -normal;
  if (plane < 0) {
    plane = static_cast<int>(planes.size());
    planes.emplace_back(normal.x(), normal.y(), normal.z(),
                        -normal.dot(origin));
  }
  walls.push_back({origin, u, v, normal, plane, clearance});
  return static_cast<int>(walls.size()) - 1;
}

World BuildLayout(const SyntheticOptions& options) {
  World world;
  Random random(options.seed, kLayoutStream);
  switch (options.kind) {
    case SyntheticKind::kRoom:
      AddRoom(&random, &world);
      AddRoomCameras(options, &random, &world);
      break;
    case SyntheticKind::kCloud:
      AddRoom(&random, &world);
      AddRoomCameras(options, &random, &world);
      DropPlanes(&world);
      break;
    case SyntheticKind::kPureRotation:
      AddRoom(&random, &world);
      AddRoomCameras(options, &random, &world);
      world.poses[1].center = world.poses[0].center;
      break;
    case SyntheticKind::kTwins:
      AddRoom(&random, &world);
      AddRoomCameras(options, &random, &world);
      MoveTwins(options.twin_baseline_m, &world);
      break;
    case SyntheticKind::kCollinear:
      AddRoom(&random, &world);
      AddCollinearCameras(options, &random, &world);
      break;
    case SyntheticKind::kCorridor:
      AddCorridor(options, &random, &world);
      break;
    case SyntheticKind::kRing:
      AddRing(options, &random, &world);
      break;
    case SyntheticKind::kHouse:
      AddHouse(&random, &world);
      AddHouseCameras(options, &random, &world);
      break;
    case SyntheticKind::kPlanar:
      AddPlanar(options, &random, &world);
      break;
  }
  if (options.box_offset_m > 0) AddBoxes(options.box_offset_m, &world);
  if (options.wall_bulge_m > 0) {
    for (Wall& wall : world.walls) wall.bulge = options.wall_bulge_m;
    DropPlanes(&world);
  }
  return world;
}

}  // namespace lowlap
