#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "lowlap/averaging/reliability/internal/pose_warnings.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

// A chain of eight views with true ratios, all meaningful but that of 3-4-5,
// on which `agreeing` lines agree.
SyntheticScene ChainWithAWeakRatio(int agreeing, int min_agreeing = 2) {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "chain";
  SyntheticScene synthetic = *Simulate(options);
  synthetic.scene.scale_ratios = TrueSolution(synthetic).scale_ratios;
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    const bool weak = ratio.views == ViewTriplet{3, 4, 5};
    ratio.verdict =
        weak ? RatioVerdict::kNotMeaningful : RatioVerdict::kMeaningful;
    ratio.log_ratio_stddev = 0.01;
    ratio.kinds = {{"lines", 10, weak ? agreeing : 10}};
    ratio.kinds.front().min_agreeing = min_agreeing;
  }
  return synthetic;
}

// Any two inliers will do, also of a kind that asks for three to bear each
// other out.
class AgreeingOfTwo : public ::testing::TestWithParam<int> {};

TEST_P(AgreeingOfTwo, PlaceWhatNothingElsePlacesAndAreNamed) {
  SyntheticScene synthetic = ChainWithAWeakRatio(2, GetParam());
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->num_placed, 8);
  EXPECT_THAT(summary->weak_ratios,
              ::testing::ElementsAre(ViewTriplet{3, 4, 5}));
  EXPECT_TRUE(summary->IsDoubtful());
  const auto warnings = PoseWarnings(*summary, synthetic.scene);
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const auto& w) {
    return w.find("chance explains as well") != std::string::npos;
  }));
}

INSTANTIATE_TEST_SUITE_P(MinAgreeing, AgreeingOfTwo, ::testing::Values(2, 3));

TEST(WeakRatios, AreNotUsedWhereNothingAgreesOnThem) {
  SyntheticScene synthetic = ChainWithAWeakRatio(1);
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_LT(summary->num_placed, 8);
  EXPECT_TRUE(summary->weak_ratios.empty());
}

TEST(WeakRatios, AreNotUsedWhereMeaningfulOnesDo) {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "window:2";
  SyntheticScene synthetic = *Simulate(options);
  synthetic.scene.scale_ratios = TrueSolution(synthetic).scale_ratios;
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log_ratio_stddev = 0.01;
    ratio.kinds = {{"lines", 10, 10}};
  }
  synthetic.scene.scale_ratios.front().verdict = RatioVerdict::kNotMeaningful;
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->num_placed, 8);
  EXPECT_TRUE(summary->weak_ratios.empty());
}

}  // namespace
}  // namespace lowlap
