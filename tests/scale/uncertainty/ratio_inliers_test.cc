#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scale/even_evidence.h"

namespace lowlap {
namespace {

using testing::Even;

TripletEvidence TwoKinds() {
  TripletEvidence evidence;
  evidence.kinds = {{"sure", Even({0.50, 0.51, 0.49, 3}, 0.01)},
                    {"none", nullptr},
                    {"coarse", Even({0.4, 0.7}, 0.1)}};
  return evidence;
}

TEST(EmptyRatio, ListsEveryKindWithItsCandidates) {
  TripletView triplet;
  triplet.views = {4, 5, 6};
  const ScaleRatio ratio = EmptyRatio(triplet, TwoKinds());
  EXPECT_EQ(ratio.views, triplet.views);
  ASSERT_EQ(ratio.kinds.size(), 3u);
  EXPECT_EQ(ratio.kinds[0].kind, "sure");
  EXPECT_EQ(ratio.kinds[0].candidates, 4);
  EXPECT_EQ(ratio.kinds[1].candidates, 0);
  EXPECT_EQ(ratio.kinds[2].candidates, 2);
  EXPECT_EQ(ratio.verdict, RatioVerdict::kNoCandidates);
}

TEST(RecordNfa, WritesTheTermsToTheKindsThatSpoke) {
  const RatioSupport support(TwoKinds());
  ScaleRatio ratio = EmptyRatio({}, TwoKinds());
  RatioNfa nfa;
  nfa.log10_nfa = -5;
  nfa.kinds.resize(2);
  nfa.kinds[0].log10_nfa = -4;
  nfa.kinds[1].log10_nfa = -3;
  RecordNfa(nfa, support, &ratio);
  EXPECT_EQ(ratio.log10_nfa, -5);
  EXPECT_EQ(ratio.kinds[0].log10_nfa, -4);
  EXPECT_EQ(ratio.kinds[1].log10_nfa, 0);
  EXPECT_EQ(ratio.kinds[2].log10_nfa, -3);
}

TEST(RefineOnInliers, CountsThoseWithinTheThresholdOfTheRefinedRatio) {
  const RatioSupport support(TwoKinds());
  ScaleRatio ratio = EmptyRatio({}, TwoKinds());
  RefineOnInliers({}, support, {{2, 4}, {1.5, 2}}, 0.51, &ratio);
  EXPECT_NEAR(ratio.log_ratio, 0.5, 0.005);
  EXPECT_EQ(ratio.kinds[0].inliers, 3);
  EXPECT_EQ(ratio.kinds[0].threshold_px, 2);
  EXPECT_EQ(ratio.kinds[2].inliers, 1);
  EXPECT_NEAR(
      ratio.kinds[0].information_share + ratio.kinds[2].information_share, 1,
      1e-9);
  EXPECT_GT(ratio.kinds[0].information_share, 0.9);
}

TEST(RefineOnInliers, LeavesOutAKindWithoutAThreshold) {
  const RatioSupport support(TwoKinds());
  ScaleRatio ratio = EmptyRatio({}, TwoKinds());
  RefineOnInliers({}, support, {{0, 4}, {16, 2}}, 0.5, &ratio);
  EXPECT_EQ(ratio.kinds[0].inliers, 0);
  EXPECT_EQ(ratio.kinds[0].information_share, 0);
  EXPECT_NEAR(ratio.kinds[2].information_share, 1, 1e-9);
  EXPECT_NEAR(ratio.log_ratio, 0.55, 0.03);
}

TEST(RefineOnInliers, LooksAtTheNearestCandidatesAlone) {
  const RatioSupport support(TwoKinds());
  ScaleRatio ratio = EmptyRatio({}, TwoKinds());
  RefineOnInliers({}, support, {{2, 1}, {0, 2}}, 0.5, &ratio);
  EXPECT_EQ(ratio.kinds[0].inliers, 1);
  EXPECT_NEAR(ratio.log_ratio, 0.5, 1e-9);
}

}  // namespace
}  // namespace lowlap
