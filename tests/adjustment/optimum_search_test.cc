#include "lowlap/adjustment/internal/rounds/optimum_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "test_scene.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;

// Only lines of three views carry the scale from pair to pair.
TestScene ChainOfLines(std::uint64_t seed) {
  TestSceneOptions options;
  options.num_views = 7;
  options.num_points = 600;
  options.max_point_views = 2;
  options.num_lines = 200;
  options.max_line_views = 3;
  options.noise_px = 0.1;
  options.seed = seed;
  return MakeTestScene(options);
}

// What comes after the middle view is too large.
void StretchSecondHalf(double factor, Scene* scene) {
  const std::size_t middle = scene->poses.size() / 2;
  const Vec3 pivot = std::next(scene->poses.begin(), middle)->second.center;
  for (auto it = std::next(scene->poses.begin(), middle);
       it != scene->poses.end(); ++it) {
    it->second.center = pivot + factor * (it->second.center - pivot);
  }
}

AdjustmentOptions Options() {
  AdjustmentOptions options;
  options.coplanar_ties = CoplanarTies::kPairs;
  return options;
}

bool SearchedAgain(const AdjustmentSummary& summary) {
  return std::any_of(summary.solves.begin(), summary.solves.end(),
                     [](const SolveReport& report) {
                       return report.stage.rfind("again: ", 0) == 0;
                     });
}

// All lines over the joint are out of use, and hold nothing.
TEST(OptimumSearchTest, BringsBackWhatDriftPutOutOfUse) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    TestScene test = ChainOfLines(seed);
    StretchSecondHalf(1.2, &test.scene);
    const AdjustmentSummary summary =
        test::BuildAndAdjust(&test.scene, Options());
    EXPECT_TRUE(SearchedAgain(summary));
    EXPECT_EQ(summary.solves.back().stage, "final");
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

TEST(OptimumSearchTest, LeavesGoodScenesAsGood) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    TestScene test = ChainOfLines(seed);
    test::BuildAndAdjust(&test.scene, Options());
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

TEST(OptimumSearchTest, WithoutRoundsTheObservationsStay) {
  TestScene test = ChainOfLines(1);
  AdjustmentOptions options = Options();
  options.max_outlier_rounds = 0;
  EXPECT_FALSE(SearchedAgain(test::BuildAndAdjust(&test.scene, options)));
}

}  // namespace
}  // namespace lowlap
