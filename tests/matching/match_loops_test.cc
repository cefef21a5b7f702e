#include "lowlap/matching/internal/loops/match_loops.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace lowlap {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

constexpr double kWidthPx = 1000;
constexpr FeatureIndex kInWindow = 9;

// A wall with two windows alike, which photographs see moved by some pixels.
// Points 0 to 8 and segment 0 (the left edge) are those of the first, the next
// nine and segment 1 those of the second.
class MatchLoopsTest : public ::testing::Test {
 protected:
  MatchLoopsTest() {
    const std::map<ViewId, Vec2> offset_px = {
        {0, {0, 0}}, {1, {-60, 4}}, {2, {-130, -3}}, {3, {-90, 1}}};
    for (const auto& [view, offset] : offset_px) {
      ViewFeatures& features = features_[view];
      for (const Vec2& window : {Vec2(300, 200), Vec2(600, 200)}) {
        for (FeatureIndex n = 0; n < kInWindow; ++n) {
          features.points_px.push_back(window + offset +
                                       Vec2(20.0 * (n % 3), 20.0 * (n / 3)));
        }
        features.segments.push_back(
            {window + offset, window + offset + Vec2(0, 40)});
      }
    }
    std::map<ViewId, MatchLoops::View> views;
    for (const auto& [view, features] : features_) {
      views[view] = {&features, kWidthPx};
    }
    loops_ = MatchLoops(std::move(views));
  }

  // Window to window.
  static std::vector<FeatureMatch> Matches(FeatureIndex from, FeatureIndex to) {
    std::vector<FeatureMatch> matches;
    for (FeatureIndex n = 0; n < kInWindow; ++n) {
      matches.push_back({from * kInWindow + n, to * kInWindow + n});
    }
    return matches;
  }
  static std::vector<FeatureMatch> All() {
    std::vector<FeatureMatch> matches = Matches(0, 0);
    for (const FeatureMatch& match : Matches(1, 1)) matches.push_back(match);
    return matches;
  }

  std::map<ViewId, ViewFeatures> features_;
  MatchLoops loops_ = MatchLoops({});
};

TEST_F(MatchLoopsTest, TellNothingWithoutAThirdView) {
  EXPECT_THAT(loops_.OfPoints({0, 2}, All()), Each(LoopVerdict::kUntold));
  loops_.Add({0, 1}, All());
  loops_.Add({2, 3}, All());
  EXPECT_THAT(loops_.OfPoints({0, 2}, All()), Each(LoopVerdict::kUntold));
}

TEST_F(MatchLoopsTest, CloseForWhatIsTheSame) {
  loops_.Add({0, 1}, All());
  loops_.Add({1, 2}, All());
  EXPECT_THAT(loops_.OfPoints({0, 2}, All()), Each(LoopVerdict::kCloses));
  EXPECT_THAT(loops_.OfLines({0, 2}, {{0, 0}, {1, 1}}),
              Each(LoopVerdict::kCloses));
  EXPECT_THAT(loops_.OfPoints({0, 2}, {}), ElementsAre());
}

TEST_F(MatchLoopsTest, LeadElsewhereForTheNextWindow) {
  loops_.Add({0, 1}, All());
  loops_.Add({1, 2}, All());
  EXPECT_THAT(loops_.OfPoints({0, 2}, Matches(1, 0)),
              Each(LoopVerdict::kLeadsElsewhere));
  EXPECT_THAT(loops_.OfLines({0, 2}, {{1, 0}, {0, 1}, {0, 0}}),
              ElementsAre(LoopVerdict::kLeadsElsewhere,
                          LoopVerdict::kLeadsElsewhere, LoopVerdict::kCloses));
}

// Along the wall an edge looks the same: only across it can be told.
TEST_F(MatchLoopsTest, CompareSegmentsAcrossTheLine) {
  for (auto& entry : features_) {
    for (LineSegment& segment : entry.second.segments) {
      segment.end_px = segment.start_px + Vec2(40, 0);
    }
  }
  loops_.Add({0, 1}, All());
  loops_.Add({1, 2}, All());
  EXPECT_THAT(loops_.OfLines({0, 2}, {{1, 0}}),
              ElementsAre(LoopVerdict::kCloses));
}

TEST_F(MatchLoopsTest, TellOfWhatTheThirdViewSees) {
  loops_.Add({0, 1}, Matches(0, 0));
  loops_.Add({1, 2}, All());
  EXPECT_THAT(loops_.OfPoints({0, 2}, Matches(0, 0)),
              Each(LoopVerdict::kCloses));
  EXPECT_THAT(loops_.OfPoints({0, 2}, Matches(1, 0)),
              Each(LoopVerdict::kUntold));
  EXPECT_THAT(loops_.OfLines({0, 2}, {{1, 0}}),
              ElementsAre(LoopVerdict::kUntold));
}

TEST_F(MatchLoopsTest, HearMostOfTheThirdViews) {
  loops_.Add({0, 1}, All());
  loops_.Add({1, 2}, All());
  loops_.Add({0, 3}, Matches(0, 1));
  loops_.Add({2, 3}, All());
  // One for, one against.
  EXPECT_THAT(loops_.OfPoints({0, 2}, Matches(0, 0)),
              Each(LoopVerdict::kUntold));
  EXPECT_THAT(loops_.OfPoints({0, 2}, Matches(1, 1)),
              Each(LoopVerdict::kCloses));
}

TEST_F(MatchLoopsTest, KeepOutOfImagesOfUnknownSize) {
  MatchLoops unknown({{0, {&features_.at(0), 0}},
                      {1, {&features_.at(1), kWidthPx}},
                      {2, {&features_.at(2), kWidthPx}}});
  unknown.Add({0, 1}, All());
  unknown.Add({1, 2}, All());
  EXPECT_THAT(unknown.OfPoints({0, 2}, Matches(1, 0)),
              Each(LoopVerdict::kUntold));
}

}  // namespace
}  // namespace lowlap
