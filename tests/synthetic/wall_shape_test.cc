#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include "lowlap/synthetic/internal/coplanar_truth.h"
#include "lowlap/synthetic/internal/world.h"

namespace lowlap {
namespace {

World Build(const SyntheticOptions& options) {
  World world = BuildLayout(options);
  FillWalls(options, 0, &world);
  return world;
}

double HeightAbove(const Wall& wall, const Vec3& place) {
  return wall.inward.dot(place - wall.origin);
}

// Where the place is along the wall's `u`, 0 to 1.
double AlongU(const Wall& wall, const Vec3& place) {
  const Vec3 across = wall.inward.cross(wall.v);
  return across.dot(place - wall.origin) / across.dot(wall.u);
}

TEST(WallBulge, PutsEverythingOnTheBowedWall) {
  SyntheticOptions options;
  options.wall_bulge_m = 0.3;
  const World world = Build(options);
  EXPECT_TRUE(world.planes.empty());
  ASSERT_EQ(world.points.size(), 6u * options.points_per_wall);
  ASSERT_EQ(world.lines.size(), 6u * options.lines_per_wall);
  const auto expect_on_surface = [&](const Wall& wall, const Vec3& place) {
    const double off_middle = 2 * AlongU(wall, place) - 1;
    EXPECT_NEAR(HeightAbove(wall, place), -0.3 * (1 - off_middle * off_middle),
                1e-12);
  };
  double deepest = 0;
  for (const WorldPoint& point : world.points) {
    const Wall& wall = world.walls[point.wall];
    expect_on_surface(wall, point.position);
    deepest = std::min(deepest, HeightAbove(wall, point.position));
  }
  EXPECT_LT(deepest, -0.29);
  for (const WorldLine& line : world.lines) {
    const Wall& wall = world.walls[line.wall];
    EXPECT_TRUE(line.planes.empty());
    for (const double s : {0.0, 0.5, 1.0}) {
      expect_on_surface(wall, line.start + s * (line.end - line.start));
    }
    EXPECT_GT((line.end - line.start).norm(), 0.1);
  }
}

TEST(BoxOffset, PutsThePartInTheMiddleOnAParallelPlane) {
  SyntheticOptions options;
  const World plain = Build(options);
  options.box_offset_m = 0.05;
  const World world = Build(options);
  ASSERT_EQ(world.planes.size(), 2 * plain.planes.size());
  ASSERT_EQ(world.points.size(), plain.points.size());
  ASSERT_EQ(world.lines.size(), plain.lines.size());
  int num_before = 0;
  for (std::size_t n = 0; n < world.points.size(); ++n) {
    const WorldPoint& point = world.points[n];
    const Wall& wall = world.walls[point.wall];
    const double height = HeightAbove(wall, point.position);
    const bool is_before = height > 0.01;
    EXPECT_NEAR(height, is_before ? 0.05 : 0, 1e-12);
    EXPECT_NEAR(
        (point.position - plain.points[n].position - height * wall.inward)
            .norm(),
        0, 1e-12);
    EXPECT_LT(std::abs(AlongU(wall, point.position) - 0.5),
              is_before ? 0.3 : 0.5 + 1e-12);
    num_before += is_before ? 1 : 0;
  }
  EXPECT_NEAR(num_before, 0.36 * static_cast<double>(world.points.size()), 60);
  std::set<int> planes;
  for (const WorldLine& line : world.lines) {
    for (const int plane : line.planes) {
      planes.insert(plane);
      EXPECT_NEAR(world.planes[plane].dot(line.start.homogeneous()), 0, 1e-9);
      EXPECT_NEAR(world.planes[plane].dot(line.end.homogeneous()), 0, 1e-9);
    }
  }
  EXPECT_EQ(planes.size(), world.planes.size());
}

TEST(BoxOffset, SectionsOfOnePlaneShareThatOfTheirBoxes) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kCorridor;
  options.box_offset_m = 0.05;
  const SyntheticScene corridor = *Simulate(options);
  for (const auto& [id, line] : corridor.true_lines) {
    for (const int plane : line.planes) {
      EXPECT_NEAR(corridor.planes[plane].dot(line.start.homogeneous()), 0,
                  1e-9);
    }
  }
}

TEST(Cloud, HasNoTwoLinesOnAPlane) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kCloud;
  const SyntheticScene cloud = *Simulate(options);
  EXPECT_TRUE(cloud.planes.empty());
  EXPECT_EQ(CountCoplanarCandidates(cloud).WrongShare(), 1);
  // Nor are any parallel, as at random: cosines are even.
  std::vector<Vec3> directions;
  for (const auto& [id, line] : cloud.true_lines) {
    directions.push_back((line.end - line.start).normalized());
  }
  double sum = 0, count = 0;
  for (std::size_t a = 0; a < directions.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b, ++count) {
      sum += std::abs(directions[a].dot(directions[b]));
    }
  }
  EXPECT_NEAR(sum / count, 0.5, 0.02);
  // A wall's points reach as far before it as its lines may.
  const World world = Build(options);
  double farthest = 0;
  for (const WorldPoint& point : world.points) {
    const Wall& wall = world.walls[point.wall];
    const double share = HeightAbove(wall, point.position) / wall.clearance;
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    farthest = std::max(farthest, share);
  }
  EXPECT_GT(farthest, 0.95);
}

}  // namespace
}  // namespace lowlap
