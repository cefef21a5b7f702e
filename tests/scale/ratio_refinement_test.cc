#include "lowlap/scale/ratio_refinement.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "lowlap/core/random.h"

namespace lowlap {
namespace {

std::vector<RatioInlier> Measurements(int count, double stddev,
                                      Random* random) {
  std::vector<RatioInlier> inliers;
  for (int n = 0; n < count; ++n) {
    RatioInlier inlier;
    inlier.log_ratio_stddev = stddev;
    inlier.log_ratio = 0.3 + random->Gaussian(stddev);
    inlier.cell = n;
    inliers.push_back(inlier);
  }
  return inliers;
}

TEST(RefineRatio, WithoutInliersKeepsTheStart) {
  const RefinedRatio refined = RefineRatio({}, 0.7);
  EXPECT_EQ(refined.log_ratio, 0.7);
  EXPECT_TRUE(std::isinf(refined.log_ratio_stddev));
}

TEST(RefineRatio, PreciseInliersWeighMore) {
  RatioInlier precise, vague;
  precise.log_ratio = 0.1;
  precise.log_ratio_stddev = 0.01;
  vague.log_ratio = 0.12;
  vague.log_ratio_stddev = 0.1;
  const RefinedRatio refined = RefineRatio({precise, vague}, 0.1);
  EXPECT_NEAR(refined.log_ratio, 0.1, 0.001);
}

TEST(RefineRatio, DeviationFallsWithTheRootOfTheCount) {
  Random random(1);
  const double few =
      RefineRatio(Measurements(100, 0.02, &random), 0.3).log_ratio_stddev;
  const double many =
      RefineRatio(Measurements(10000, 0.02, &random), 0.3).log_ratio_stddev;
  EXPECT_NEAR(few, 0.002, 0.0007);
  EXPECT_NEAR(many, 0.0002, 0.00004);
}

TEST(RefineRatio, OutliersHardlyMoveIt) {
  Random random(2);
  std::vector<RatioInlier> inliers = Measurements(200, 0.01, &random);
  for (int n = 0; n < 60; ++n) inliers[n].log_ratio = 0.5;
  EXPECT_NEAR(RefineRatio(inliers, 0.3).log_ratio, 0.3, 0.005);
}

TEST(RefineRatio, RepeatedMeasurementsAreNotNewOnes) {
  Random random(3);
  std::vector<RatioInlier> once = Measurements(100, 0.02, &random);
  std::vector<RatioInlier> repeated;
  for (RatioInlier inlier : once) {
    inlier.multiplicity = 10;
    for (int copy = 0; copy < 10; ++copy) repeated.push_back(inlier);
  }
  EXPECT_NEAR(RefineRatio(repeated, 0.3).log_ratio_stddev /
                  RefineRatio(once, 0.3).log_ratio_stddev,
              1.0, 0.15);
}

TEST(RefineRatio, ErrorsSharedByACellDoNotAverageOut) {
  Random random(4);
  constexpr int kCells = 16, kPerCell = 100;
  std::vector<RatioInlier> inliers;
  for (int cell = 0; cell < kCells; ++cell) {
    const double shared = random.Gaussian(0.01);
    for (RatioInlier inlier : Measurements(kPerCell, 0.01, &random)) {
      inlier.log_ratio += shared;
      inlier.cell = cell;
      inliers.push_back(inlier);
    }
  }
  const double stddev = RefineRatio(inliers, 0.3).log_ratio_stddev;
  EXPECT_GT(stddev, 0.6 * 0.01 / std::sqrt(kCells));
  EXPECT_LT(stddev, 2.0 * 0.01 / std::sqrt(kCells));
}

}  // namespace
}  // namespace lowlap
