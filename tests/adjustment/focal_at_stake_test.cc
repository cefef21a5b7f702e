#include <gtest/gtest.h>

#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/geometry/similarity.h"
#include "test_scene.h"

namespace lowlap {
namespace {

using test::BuildAndAdjust;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;

// Points of two views each: they do not hold the scene together, and say
// nothing of a calibration.
TestSceneOptions HeldByLines(std::uint64_t seed) {
  TestSceneOptions options;
  options.num_points = 60;
  options.max_point_views = 2;
  options.num_lines = 80;
  options.max_line_views = 4;
  options.pairs_per_triplet = 5;
  options.noise_px = 0.5;
  options.seed = seed;
  return options;
}

struct Centers {
  double squared_error = 0;
  double variance = 0;
  bool is_preferred = false;
};

// Sums over the centres of a scene whose focal length is off by the factor.
Centers Adjusted(TestScene test, double factor, bool test_calibration) {
  for (auto& entry : test.scene.intrinsics) {
    entry.second.fx_px *= factor;
    entry.second.fy_px *= factor;
  }
  AdjustmentOptions options;
  options.test_calibration = test_calibration;
  Centers centers;
  centers.is_preferred =
      !BuildAndAdjust(&test.scene, options).calibration_preferences.empty();
  std::vector<Vec3> solved, truth;
  for (const auto& [id, pose] : test.scene.poses) {
    solved.push_back(pose.center);
    truth.push_back(test.true_poses.at(id).center);
    centers.variance += pose.center_covariance->trace();
  }
  const Similarity solved_from_truth = AlignPoints(truth, solved).value();
  for (std::size_t n = 0; n < solved.size(); ++n) {
    centers.squared_error +=
        (solved[n] - solved_from_truth * truth[n]).squaredNorm();
  }
  return centers;
}

TEST(FocalAtStake, IsStatedWhereNothingContradictsIt) {
  constexpr int kSeeds = 2;
  for (const double factor : {0.9, 1.1}) {
    double with = 0, without = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const TestScene test = MakeTestScene(HeldByLines(seed));
      const Centers stated = Adjusted(test, factor, true);
      EXPECT_FALSE(stated.is_preferred);
      const Centers silent = Adjusted(test, factor, false);
      with += stated.squared_error / stated.variance / kSeeds;
      without += silent.squared_error / silent.variance / kSeeds;
    }
    EXPECT_GT(without, 10);
    EXPECT_LT(with, 3);
    EXPECT_GT(with, 0.3);
  }
}

// Nothing where noise explains what the images prefer; else never less.
TEST(FocalAtStake, AddsLittleToATrueOne) {
  constexpr int kSeeds = 6;
  double with = 0, without = 0;
  int unchanged = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const TestScene test = MakeTestScene(HeldByLines(seed));
    const double stated = Adjusted(test, 1, true).variance;
    const double silent = Adjusted(test, 1, false).variance;
    EXPECT_GE(stated, silent);
    unchanged += stated == silent ? 1 : 0;
    with += stated;
    without += silent;
  }
  EXPECT_GT(unchanged, 0);
  EXPECT_LT(with, 1.25 * without);
}

TEST(FocalAtStake, NothingIfItIsRefined) {
  TestScene test = MakeTestScene(HeldByLines(1));
  AdjustmentOptions options;
  for (const auto& entry : test.scene.intrinsics) {
    options.refine_intrinsics[entry.first] = {true, true, true, true};
  }
  TestScene untested = test;
  BuildAndAdjust(&test.scene, options);
  options.test_calibration = false;
  BuildAndAdjust(&untested.scene, options);
  for (const auto& [id, pose] : test.scene.poses) {
    EXPECT_EQ(*pose.center_covariance,
              *untested.scene.poses.at(id).center_covariance);
  }
}

}  // namespace
}  // namespace lowlap
