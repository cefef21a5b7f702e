#include "lowlap/scale/evidence/internal/plane_points.h"

#include <gtest/gtest.h>

#include "lowlap/scale/evidence/internal/triplet_points.h"
#include "scale/synthetic_planes.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticPlanes;
using testing::SyntheticPlanes;
using testing::SyntheticPlanesOptions;

TEST(FindPlanePoints, GivesTheRatioExactlyWithoutNoise) {
  for (const bool lines : {false, true}) {
    SyntheticPlanesOptions options;
    if (lines) {
      options.num_points_per_wall = 0;
      options.num_lines_per_wall = 20;
    }
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, 2);
    const std::vector<PlanePoint> points = scene.Points();
    EXPECT_EQ(points.size(), 3u);
    for (const PlanePoint& point : points) {
      EXPECT_NEAR(point.ratio.log_ratio, scene.true_log_ratio, 1e-6);
      EXPECT_GE(point.num_samples, 3);
    }
  }
}

TEST(FindPlanePoints, RelatesPointsOfOnePairToLinesOfTheOther) {
  SyntheticPlanesOptions options;
  options.num_lines_per_wall = 20;
  SyntheticPlanes scene = MakeSyntheticPlanes(options, 2);
  scene.lines_ij.clear();
  scene.points_jk.clear();
  const std::vector<PlanePoint> points = scene.Points();
  EXPECT_EQ(points.size(), 3u);
  for (const PlanePoint& point : points) {
    EXPECT_NEAR(point.ratio.log_ratio, scene.true_log_ratio, 1e-6);
  }
}

TEST(FindPlanePoints, AreTrifocalPointsOfTheSameRatio) {
  SyntheticPlanesOptions options;
  options.noise_px = 1;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 3);
  const std::vector<PlanePoint> points = scene.Points();
  ASSERT_FALSE(points.empty());
  for (const PlanePoint& point : points) {
    const RatioCandidate ratio =
        TripletPointSolver(scene.geometry).Ratio(point.point);
    ASSERT_EQ(ratio.status, CandidateStatus::kValid);
    EXPECT_NEAR(ratio.log_ratio, point.ratio.log_ratio, 1e-6);
  }
}

TEST(FindPlanePoints, StatesItsDeviation) {
  SyntheticPlanesOptions options;
  options.noise_px = 1;
  int all = 0, within = 0;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, seed);
    for (const PlanePoint& point : scene.Points()) {
      const double error = point.ratio.log_ratio - scene.true_log_ratio;
      within += std::abs(error) < 2 * point.ratio.log_ratio_stddev;
      sum += point.ratio.log_ratio_stddev;
      ++all;
    }
  }
  EXPECT_GT(all, 100);
  EXPECT_GT(within, 0.88 * all);
  EXPECT_LT(sum / all, 0.02);
}

TEST(FindPlanePoints, SwapWithTheEndsOfTheTriplet) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 4);
  const std::vector<PlanePoint> points = scene.Points();
  const std::vector<PlanePoint> swapped = FindPlanePoints(
      scene.geometry.Swapped(), scene.PlanesJk(), scene.PlanesIj());
  ASSERT_EQ(points.size(), swapped.size());
  for (const PlanePoint& point : points) {
    int found = 0;
    for (const PlanePoint& other : swapped) {
      if (other.plane != point.plane ||
          other.plane_is_first == point.plane_is_first) {
        continue;
      }
      ++found;
      EXPECT_DOUBLE_EQ(other.ratio.log_ratio, -point.ratio.log_ratio);
      EXPECT_DOUBLE_EQ(other.ratio.log_ratio_stddev,
                       point.ratio.log_ratio_stddev);
      EXPECT_EQ(other.point.in_i, point.point.in_k);
    }
    EXPECT_EQ(found, 1);
  }
}

TEST(FindPlanePoints, PassOverFeaturesThatThreeViewsShare) {
  SyntheticPlanes scene = MakeSyntheticPlanes({}, 5);
  // The same features in both pairs: only the trifocal ones are left.
  for (std::size_t n = 0; n < scene.points_jk.size(); ++n) {
    scene.points_jk[n].point_in_middle = scene.points_ij[n].point_in_middle;
  }
  EXPECT_TRUE(scene.Points().empty());
}

TEST(FindPlanePoints, HaveNoneWithoutPlanes) {
  SyntheticPlanesOptions options;
  options.num_points_per_wall = 0;
  options.num_scattered = 20;
  EXPECT_TRUE(MakeSyntheticPlanes(options, 6).Points().empty());
  EXPECT_TRUE(
      FindPlanePoints(TripletGeometry(), PairPlanes(), PairPlanes()).empty());
}

}  // namespace
}  // namespace lowlap
