#include "lowlap/matching/internal/repeats/repeated_pattern.h"

#include <gtest/gtest.h>

#include "lowlap/matching/internal/repeats/alike_places.h"
#include "tests/matching/pattern_view.h"

namespace lowlap {
namespace {

using testing::AddOthers;
using testing::AddPattern;
using testing::ObliqueCamera;
using testing::PatternView;
using testing::RandomDescriptor;

constexpr int kColumns = 7, kRows = 5, kMotif = 3;
constexpr int kInPattern = kColumns * kRows * kMotif;

PatternView EmptyView() {
  PatternView view;
  view.features.focal_px = 1000;
  return view;
}

PatternView TiledView(int num_others, std::uint64_t seed) {
  PatternView view = EmptyView();
  Random random(seed);
  AddPattern(kColumns, kRows, kMotif, 0.3, ObliqueCamera(), &random, &view);
  AddOthers(num_others, &random, &view);
  return view;
}

int CountIn(const RepeatedPattern& pattern, int begin, int end) {
  int count = 0;
  for (int n = begin; n < end; ++n) count += pattern.HasPoint(n) ? 1 : 0;
  return count;
}

TEST(RepeatedPattern, HoldsTheCopiesAndFewOfTheRest) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const PatternView view = TiledView(60, seed);
    const RepeatedPattern pattern = RepeatedPattern::Find(view.View());
    EXPECT_FALSE(pattern.IsEmpty());
    EXPECT_GT(CountIn(pattern, 0, kInPattern), kInPattern / 2);
    // Those within a window of 12 px of a copy.
    EXPECT_LT(CountIn(pattern, kInPattern, kInPattern + 60), 20);
  }
}

TEST(RepeatedPattern, HoldsSegmentsOfWhichItCoversBothEnds) {
  const PatternView view = TiledView(60, 1);
  const RepeatedPattern pattern = RepeatedPattern::Find(view.View());
  const std::vector<Vec3>& points = view.features.points;
  std::vector<FeatureIndex> members;
  for (FeatureIndex n = 0; n < kInPattern && members.size() < 2; ++n) {
    if (pattern.HasPoint(n)) members.push_back(n);
  }
  ASSERT_EQ(members.size(), 2u);
  const auto segment = [](const Vec3& start, const Vec3& end) {
    return NormalizedSegment{start, end, start.cross(end).normalized()};
  };
  const Vec3 &a = points[members[0]], &b = points[members[1]];
  const Vec3 away(2, 2, 1);
  EXPECT_TRUE(pattern.HasSegment(segment(a, b)));
  EXPECT_FALSE(pattern.HasSegment(segment(a, away)));
  EXPECT_FALSE(pattern.HasSegment(segment(away, b)));
  EXPECT_FALSE(pattern.HasSegment({a, b, Vec3::Zero()}));
  EXPECT_FALSE(RepeatedPattern().HasSegment(segment(a, b)));
}

// Only so many points are looked at for translations.
TEST(RepeatedPattern, HoldsCopiesOfSmallThings) {
  PatternView view = EmptyView();
  Random random(9);
  constexpr int kLargeMotif = 30;
  AddPattern(kColumns, kRows, kLargeMotif, 0.3, ObliqueCamera(), &random,
             &view);
  AddOthers(2000 - kColumns * kRows * kLargeMotif, &random, &view);
  const int num_large = static_cast<int>(view.keypoints.size());
  AddPattern(kColumns, kRows, kMotif, 0.1, ObliqueCamera(), &random, &view);
  const int num_all = static_cast<int>(view.keypoints.size());
  for (int n = num_large; n < num_all; ++n) view.keypoints[n].scale_px = 1;
  const RepeatedPattern pattern = RepeatedPattern::Find(view.View());
  EXPECT_GT(CountIn(pattern, num_large, num_all), kInPattern / 2);
}

TEST(RepeatedPattern, KnowsWhichPlacesAreCopies) {
  const PatternView view = TiledView(60, 1);
  const RepeatedPattern pattern = RepeatedPattern::Find(view.View());
  const std::vector<Vec3>& points = view.features.points;
  // In the middle, of the first point of the motif.
  constexpr int kCells = kColumns * kRows, kMiddle = kCells / 2;
  int num_copies = 0, num_others = 0;
  for (int n = 0; n < kInPattern; ++n) {
    if (n == kMiddle) continue;
    const bool are_copies = pattern.AreCopies(points[kMiddle], points[n], 3);
    EXPECT_EQ(are_copies, pattern.AreCopies(points[n], points[kMiddle], 3));
    (n < kCells ? num_copies : num_others) += are_copies ? 1 : 0;
  }
  EXPECT_GT(num_copies, 2);
  EXPECT_LT(num_others, 3);
  EXPECT_FALSE(RepeatedPattern().AreCopies(points[0], points[1], 3));
}

TEST(RepeatedPattern, IsEmptyWhereNothingRepeats) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    PatternView view = EmptyView();
    Random random(seed);
    AddOthers(400, &random, &view);
    EXPECT_TRUE(RepeatedPattern::Find(view.View()).IsEmpty());
  }
  EXPECT_TRUE(RepeatedPattern::Find(EmptyView().View()).IsEmpty());
  EXPECT_FALSE(RepeatedPattern().HasPoint(0));
}

TEST(RepeatedPattern, AnEdgeThatLooksAlikeAllAlongIsNone) {
  PatternView view = EmptyView();
  Random random(4);
  const PointDescriptor descriptor = RandomDescriptor(&random);
  for (int n = 0; n < 60; ++n) {
    const double share = n / 60.0;
    const double across = random.Gaussian(1e-3);
    view.Add(Vec3(-0.5 + share, -0.3 + 0.4 * share + across, 1),
             testing::Resembling(descriptor, &random), 2);
  }
  AddOthers(200, &random, &view);
  EXPECT_TRUE(RepeatedPattern::Find(view.View()).IsEmpty());
}

TEST(RepeatedPattern, CoversWhatLooksThroughTheSameWindow) {
  const PatternView view = TiledView(0, 5);
  const RepeatedPattern pattern = RepeatedPattern::Find(view.View());
  int member = 0;
  while (!pattern.HasPoint(member)) ++member;
  const Vec3 place = view.features.points[member];
  const double px = 1 / view.features.focal_px;
  EXPECT_TRUE(pattern.Covers(place, 2));
  EXPECT_TRUE(pattern.Covers(place + Vec3(5 * px, 0, 0), 2));
  EXPECT_FALSE(pattern.Covers(Vec3(10, 10, 1), 100));
  // Another thing beside it, seen in detail.
  EXPECT_FALSE(pattern.Covers(place + Vec3(0, 5 * px, 0), 0.1));
}

TEST(RepeatedPattern, TheSameForTheSameView) {
  const PatternView view = TiledView(100, 6);
  const RepeatedPattern a = RepeatedPattern::Find(view.View());
  const RepeatedPattern b = RepeatedPattern::Find(view.View());
  for (int n = 0; n < kInPattern + 100; ++n) {
    EXPECT_EQ(a.HasPoint(n), b.HasPoint(n)) << n;
  }
}

TEST(RepeatedPattern, RaysWithoutAnImageHaveNone) {
  PatternView view = TiledView(0, 7);
  for (Vec3& x : view.features.points) x.setZero();
  EXPECT_TRUE(RepeatedPattern::Find(view.View()).IsEmpty());
}

TEST(FindAlikePlaces, JoinsCopiesOutsideTheirWindowsOnly) {
  PatternView view = EmptyView();
  Random random(8);
  const PointDescriptor descriptor = RandomDescriptor(&random);
  view.Add(Vec3(0, 0, 1), descriptor, 2);
  view.Add(Vec3(0.008, 0, 1), descriptor, 2);  // in the same window
  view.Add(Vec3(0.3, 0.1, 1), descriptor, 2);
  view.Add(Vec3(-0.3, 0.2, 1), descriptor, 8);  // another size
  view.Add(Vec3(-0.4, -0.2, 1), RandomDescriptor(&random), 2);
  const auto places = FindAlikePlaces(view.View(), {0, 1, 2, 3, 4});
  bool is_joined = false;
  for (const AlikePlaces& place : places) {
    if (place.first == 0) {
      EXPECT_EQ(place.second, 2);
      is_joined = true;
    }
    EXPECT_NE(place.first, 3);
    EXPECT_NE(place.second, 3);
  }
  EXPECT_TRUE(is_joined);
}

}  // namespace
}  // namespace lowlap
