#include "lowlap/adjustment/internal/rounds/optimum_search.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <iterator>

#include "line_chain.h"

namespace lowlap {
namespace {

using test::ChainOfLines;
using test::ComparePoses;
using test::SearchedFrom;
using test::TestScene;
using test::WithPairs;

// What comes after the middle view is too large.
void StretchSecondHalf(double factor, Scene* scene) {
  const std::size_t middle = scene->poses.size() / 2;
  const Vec3 pivot = std::next(scene->poses.begin(), middle)->second.center;
  for (auto it = std::next(scene->poses.begin(), middle);
       it != scene->poses.end(); ++it) {
    it->second.center = pivot + factor * (it->second.center - pivot);
  }
}

// All lines over the joint are out of use, and hold nothing.
TEST(OptimumSearchTest, BringsBackWhatDriftPutOutOfUse) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    TestScene test = ChainOfLines(seed);
    StretchSecondHalf(1.2, &test.scene);
    const AdjustmentSummary summary =
        test::BuildAndAdjust(&test.scene, WithPairs());
    EXPECT_TRUE(SearchedFrom("again", summary));
    EXPECT_EQ(summary.solves.back().stage, "final");
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

TEST(OptimumSearchTest, LeavesGoodScenesAsGood) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    TestScene test = ChainOfLines(seed);
    test::BuildAndAdjust(&test.scene, WithPairs());
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

TEST(OptimumSearchTest, WithoutRoundsTheObservationsStay) {
  TestScene test = ChainOfLines(1);
  AdjustmentOptions options = WithPairs();
  options.max_outlier_rounds = 0;
  EXPECT_FALSE(
      SearchedFrom("again", test::BuildAndAdjust(&test.scene, options)));
}

}  // namespace
}  // namespace lowlap
