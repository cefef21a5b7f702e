#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "lowlap/averaging/reliability/internal/find_reliability_warnings.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Triangles {0, 1, 2, 7}, {0, 3, 4} and {0, 5, 6} that meet in view 0, and the
// evidence of the ratios across it that agree, and of those that do not.
struct Star {
  Scene scene;
  SolutionAgreement agreement;

  Star() {
    for (const ViewPair& views : {ViewPair{0, 1},
                                  {0, 2},
                                  {1, 2},
                                  {1, 7},
                                  {2, 7},
                                  {0, 3},
                                  {0, 4},
                                  {3, 4},
                                  {0, 5},
                                  {0, 6},
                                  {5, 6}}) {
      RelativePose pose;
      pose.views = views;
      pose.log10_nfa = -100;
      scene.relative_poses[views] = pose;
      agreement.held.push_back(views);
      agreement.agreeing.push_back(views);
    }
    std::sort(agreement.held.begin(), agreement.held.end());
    std::sort(agreement.agreeing.begin(), agreement.agreeing.end());
    for (std::uint32_t n = 0; n < 8; ++n) {
      scene.views[n] = View();
      agreement.placed.push_back(n);
    }
  }

  void Add(const ViewTriplet& views, double evidence, bool agrees) {
    ScaleRatio ratio;
    ratio.views = views;
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log_ratio_stddev = 0.01;
    ratio.log10_nfa = 1 - evidence;
    ratio.kinds = {{"lines", 20, 20}};
    scene.scale_ratios.push_back(ratio);
    (agrees ? agreement.agreeing_ratios : agreement.rejected_ratios)
        .push_back(views);
  }

  std::vector<ReliabilityWarning> Warnings() const {
    FirmEvidence firm;
    return FindReliabilityWarnings(scene, agreement, {}, &firm);
  }
};

// Ratios between other parts say nothing for it, nor are these doubtful.
TEST(ContradictedArticulation, RatiosBetweenTheSamePartsAreCompared) {
  Star star;
  star.Add({1, 0, 3}, 10, true);
  star.Add({1, 0, 5}, 100, true);
  EXPECT_THAT(star.Warnings(), IsEmpty());
  star.Add({2, 0, 4}, 30, false);
  const auto warnings = star.Warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kContradictedRatios);
  EXPECT_THAT(warnings[0].views, ElementsAre(3, 4));
  EXPECT_THAT(warnings[0].ratios, ElementsAre(ViewTriplet{2, 0, 4}));
}

TEST(ContradictedArticulation, NoneWhereAThirdPartHolds) {
  Star star;
  star.Add({1, 0, 3}, 10, true);
  star.Add({1, 0, 5}, 100, true);
  star.Add({3, 0, 5}, 100, true);
  star.Add({2, 0, 4}, 30, false);
  EXPECT_THAT(star.Warnings(), IsEmpty());
}

}  // namespace
}  // namespace lowlap
