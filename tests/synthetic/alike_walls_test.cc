#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

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
    const bool is_copy = point.wall >= 2 && along < 0.4 * wall.u.squaredNorm();
    EXPECT_EQ(point.alike >= 0, is_copy) << n;
    if (!is_copy) continue;
    ++num_alike;
    const WorldPoint& original = world.points[point.alike];
    EXPECT_EQ(original.wall + 2, point.wall);
    EXPECT_LT((original.position - HalfTurned(point.position)).norm(), 1e-9)
        << n;
  }
  EXPECT_NEAR(static_cast<double>(num_alike) / world.points.size(), 0.2, 0.04);
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
    const WorldLine& original = world.lines[line.alike];
    EXPECT_LT((original.start - HalfTurned(line.start)).norm(), 1e-9);
    EXPECT_LT((original.end - HalfTurned(line.end)).norm(), 1e-9);
    EXPECT_EQ(original.planes.size(), line.planes.size());
  }
  EXPECT_GT(num_alike, world.lines.size() / 10);
}

TEST(AlikeWalls, NoMatchJoinsWhatLooksTheSame) {
  const SyntheticScene synthetic = MustSimulate(House(0.4));
  EXPECT_FALSE(synthetic.alike_points.empty());
  EXPECT_FALSE(synthetic.alike_lines.empty());
  for (const auto& alike : synthetic.alike_points) {
    const Vec3& first = synthetic.true_points.at(alike.first);
    const Vec3& second = synthetic.true_points.at(alike.second);
    EXPECT_LT((second - HalfTurned(first)).norm(), 1e-9);
    EXPECT_LT((alike.first_from_second * second - first).norm(), 1e-9);
  }
  EXPECT_TRUE(MustSimulate(House(0)).alike_points.empty());
}

SyntheticOptions Corridor(double alike_share) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kCorridor;
  options.pairs = "all";
  options.section_m = 2;
  options.alike_share = alike_share;
  return options;
}

TEST(AlikeWalls, SectionsOfACorridorCarryTheSameInAPart) {
  constexpr double kShare = 0.4;
  const SyntheticScene synthetic = MustSimulate(Corridor(kShare));
  // The corridor leads along z.
  std::map<PointTrackId, int> num_copies;
  for (const auto& alike : synthetic.alike_points) {
    EXPECT_TRUE(alike.first_from_second.isIdentity(1e-9));
    const Vec3 step = synthetic.true_points.at(alike.second) -
                      synthetic.true_points.at(alike.first);
    EXPECT_NEAR(step.x(), 0, 1e-9);
    EXPECT_NEAR(step.y(), 0, 1e-9);
    EXPECT_NEAR(step.z() / 2, std::round(step.z() / 2), 1e-9);
    EXPECT_GT(step.z(), 1);
    ++num_copies[alike.first];
  }
  std::size_t num_alike = 0;
  for (const auto& [id, point] : synthetic.true_points) {
    const double section = point.z() / 2;
    num_alike += section - std::floor(section) < kShare ? 1 : 0;
  }
  EXPECT_EQ(synthetic.alike_points.size() + num_copies.size(), num_alike);
  EXPECT_GT(synthetic.alike_points.size(), 3 * num_copies.size());
}

TEST(AlikeWalls, SectionsAreAsLongAsAskedFor) {
  SyntheticOptions options = Corridor(0);
  const std::size_t num_short = MustSimulate(options).planes.size();
  options.section_m = 4;
  EXPECT_LT(MustSimulate(options).planes.size(), 0.6 * num_short);
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
