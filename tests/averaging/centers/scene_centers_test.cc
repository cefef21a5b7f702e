#include "lowlap/averaging/centers/internal/scene_centers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "averaging/true_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kFalseFactor = 1.5;

// Solved without the relative pose of views 2 and 4, which is right; its ratios
// are off by a factor if `false_evidence` speaks for that.
std::vector<ViewPair> LeftOut(double false_evidence) {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "window:3";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  const ViewPair doubted{2, 4};
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    const auto& [first, middle, last] = ratio.views;
    ratio.log10_nfa = -10;
    const bool is_to = OrderedPair(middle, last) == doubted;
    if (!is_to && OrderedPair(first, middle) != doubted) continue;
    if (false_evidence == 0) continue;
    ratio.log10_nfa = -false_evidence;
    ratio.log_ratio += (is_to ? 1 : -1) * std::log(kFalseFactor);
  }
  const auto rotations =
      AverageSceneRotations(synthetic.scene, PoseOptions(), RunContext());
  EXPECT_TRUE(rotations);
  const auto centers = SolveSceneCenters(synthetic.scene, *rotations, {doubted},
                                         PoseOptions(), RunContext());
  EXPECT_TRUE(centers);
  EXPECT_EQ(centers->solution.NumPlaced(), 8);
  return PairsOf(centers->outlier_edges);
}

TEST(SceneCenters, WhatAgreesIsTakenInAgain) {
  EXPECT_THAT(LeftOut(0), IsEmpty());
}

// A relative pose of two places that look alike, one behind the other, has the
// right direction and a false length.
TEST(SceneCenters, WhatHasFalseRatiosIsNotTakenInAgain) {
  EXPECT_THAT(LeftOut(50), ElementsAre(ViewPair{2, 4}));
}

}  // namespace
}  // namespace lowlap
