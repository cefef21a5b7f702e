#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lowlap/synthetic/internal/world.h"
#include "synthetic/must_simulate.h"

namespace lowlap {
namespace {

using testing::MustSimulate;

SyntheticOptions House(double alike_share) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kHouse;
  options.pairs = "all";
  options.box_offset_m = 0.3;
  options.alike_share = alike_share;
  return options;
}

World BuildHouse(const SyntheticOptions& options) {
  World world = BuildLayout(options);
  FillWalls(options, 0, &world);
  MakeWallsAlike(options.alike_share, &world);
  return world;
}

Vec3 HalfTurned(const Vec3& p) { return {-p.x(), p.y(), -p.z()}; }

TEST(AlikeWalls, OppositeSidesCarryTheSameInAPart) {
  const World world = BuildHouse(House(0.4));
  std::size_t num_alike = 0;
  for (std::size_t n = 0; n < world.points.size(); ++n) {
    const WorldPoint& point = world.points[n];
    const Wall& wall = world.walls[point.wall];
    const double along = wall.u.dot(point.position - wall.origin);
    EXPECT_EQ(point.alike >= 0, along < 0.4 * wall.u.squaredNorm()) << n;
    if (point.alike < 0) continue;
    ++num_alike;
    const WorldPoint& copy = world.points[point.alike];
    EXPECT_EQ(copy.alike, static_cast<int>(n));
    EXPECT_EQ((copy.wall + 2) % 4, point.wall);
    EXPECT_LT((copy.position - HalfTurned(point.position)).norm(), 1e-9) << n;
  }
  EXPECT_NEAR(static_cast<double>(num_alike) / world.points.size(), 0.4, 0.08);
}

TEST(AlikeWalls, LinesKeepTheirPlanes) {
  const World world = BuildHouse(House(0.4));
  std::size_t num_alike = 0;
  for (const WorldLine& line : world.lines) {
    for (const int plane : line.planes) {
      for (const Vec3& end : {line.start, line.end}) {
        EXPECT_NEAR(world.planes[plane].dot(end.homogeneous()), 0, 1e-9);
      }
    }
    if (line.alike < 0) continue;
    ++num_alike;
    const WorldLine& copy = world.lines[line.alike];
    EXPECT_LT((copy.start - HalfTurned(line.start)).norm(), 1e-9);
    EXPECT_LT((copy.end - HalfTurned(line.end)).norm(), 1e-9);
    EXPECT_EQ(copy.planes.size(), line.planes.size());
  }
  EXPECT_GT(num_alike, world.lines.size() / 5);
}

TEST(AlikeWalls, NoMatchJoinsWhatLooksTheSame) {
  const SyntheticScene synthetic = MustSimulate(House(0.4));
  EXPECT_FALSE(synthetic.alike_points.empty());
  EXPECT_FALSE(synthetic.alike_lines.empty());
  for (const auto& [first, second] : synthetic.alike_points) {
    EXPECT_LT((synthetic.true_points.at(second) -
               HalfTurned(synthetic.true_points.at(first)))
                  .norm(),
              1e-9);
  }
  EXPECT_TRUE(MustSimulate(House(0)).alike_points.empty());
}

TEST(House, ViewsSeeTheSidesThatFaceThem) {
  const SyntheticScene synthetic = MustSimulate(House(0));
  EXPECT_EQ(synthetic.planes.size(), 8u);  // boxes' fronts included
  for (const auto& [id, track] : synthetic.scene.point_tracks) {
    for (const FeatureRef& ref : track) {
      const Vec3& center = synthetic.true_poses.at(ref.view).center;
      const Vec3& point = synthetic.true_points.at(id);
      const auto faces_the_view = [&](const Vec4& plane) {
        return std::abs(plane.dot(point.homogeneous())) < 1e-9 &&
               plane.dot(center.homogeneous()) > 0;
      };
      EXPECT_TRUE(std::any_of(synthetic.planes.begin(), synthetic.planes.end(),
                              faces_the_view))
          << id << " " << ref.view;
    }
  }
}

}  // namespace
}  // namespace lowlap
