#include "lowlap/pipeline/internal/measure/contradicted_matches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Key;

constexpr FeatureIndex kInWindow = 30;

// Three photographs of a wall with two windows alike, a little further each.
class ExamineLoopsTest : public ::testing::Test {
 protected:
  ExamineLoopsTest() {
    for (std::uint32_t v = 0; v < 3; ++v) {
      View& view = scene_.views[v];
      view.width_px = 1600;
      view.height_px = 1200;
      ViewFeatures& features = scene_.features[v];
      for (const double left_px : {300.0, 900.0}) {
        for (FeatureIndex n = 0; n < kInWindow; ++n) {
          features.points_px.push_back(
              {left_px - 80 * v + 25 * (n % 6), 200.0 + 25 * (n / 6)});
        }
        features.segments.push_back(
            {{left_px - 80 * v, 200}, {left_px - 80 * v, 300}});
      }
    }
    Set({0, 1}, -200, All());
    Set({0, 2}, -50, Shifted(kInWindow));
    Set({1, 2}, -100, All());
    matches_[{0, 2}].lines = {{0, 0}, {1, 0}};
  }

  static std::vector<FeatureMatch> All() {
    std::vector<FeatureMatch> matches;
    for (FeatureIndex n = 0; n < 2 * kInWindow; ++n) matches.push_back({n, n});
    return matches;
  }
  // The second window to the first, for the first `count` of its points.
  static std::vector<FeatureMatch> Shifted(FeatureIndex count) {
    std::vector<FeatureMatch> matches;
    for (FeatureIndex n = 0; n < count; ++n) {
      matches.push_back({kInWindow + n, n});
    }
    return matches;
  }

  // Putative matches, all of them inliers.
  void Set(const ViewPair& pair, double log10_nfa,
           const std::vector<FeatureMatch>& matches) {
    matches_[pair].points = matches;
    PairEstimate& estimate = estimates_[pair];
    estimate.pose.emplace();
    estimate.pose->views = pair;
    estimate.pose->point_inliers = matches;
    estimate.log10_nfa_with_repeats = log10_nfa;
  }

  std::map<std::size_t, PairMatches> Allowed() const {
    std::vector<ViewPair> pairs;
    std::vector<PairEstimate> estimates;
    for (const auto& [pair, estimate] : estimates_) {
      pairs.push_back(pair);
      estimates.push_back(estimate);
    }
    return ExamineLoops(scene_, pairs, matches_, estimates).allowed;
  }

  Scene scene_;
  std::map<ViewPair, PairMatches> matches_;
  std::map<ViewPair, PairEstimate> estimates_;
};

TEST_F(ExamineLoopsTest, LeavesOutWhatStrongerPairsContradict) {
  // Also of what is no inlier.
  matches_[{0, 2}].points.push_back({3, 3});
  matches_[{0, 2}].points.push_back({4, kInWindow + 4});
  const auto allowed = Allowed();
  ASSERT_THAT(allowed, ElementsAre(Key(1)));
  EXPECT_THAT(allowed.at(1).points, ElementsAre(FeatureMatch{3, 3}));
  EXPECT_THAT(allowed.at(1).lines, ElementsAre(FeatureMatch{0, 0}));
}

TEST_F(ExamineLoopsTest, TheStrongerTellsOfTheWeaker) {
  estimates_[{0, 2}].log10_nfa_with_repeats = -150;
  const auto allowed = Allowed();
  ASSERT_THAT(allowed, ElementsAre(Key(2)));
  // The first window of view 1 is said to be where view 2 has none.
  EXPECT_LT(allowed.at(2).points.size(), 2 * kInWindow);
}

TEST_F(ExamineLoopsTest, AFewAreNoMatter) {
  std::vector<FeatureMatch> matches = All();
  for (FeatureIndex n = 0; n < 6; ++n) matches[kInWindow + n].second = n;
  Set({0, 2}, -50, matches);
  EXPECT_THAT(Allowed(), IsEmpty());
}

TEST_F(ExamineLoopsTest, WhatIsRightStays) {
  Set({0, 2}, -50, All());
  EXPECT_THAT(Allowed(), IsEmpty());
}

TEST_F(ExamineLoopsTest, PosesWithoutEvidenceTakeNoPart) {
  estimates_[{0, 1}].log10_nfa_with_repeats = 0;
  EXPECT_THAT(Allowed(), IsEmpty());
  estimates_[{0, 1}].log10_nfa_with_repeats = -200;
  estimates_[{0, 2}].log10_nfa_with_repeats = 0;
  EXPECT_THAT(Allowed(), IsEmpty());
  estimates_[{0, 2}].log10_nfa_with_repeats = -50;
  estimates_[{0, 2}].pose.reset();
  EXPECT_THAT(Allowed(), IsEmpty());
}

}  // namespace
}  // namespace lowlap
