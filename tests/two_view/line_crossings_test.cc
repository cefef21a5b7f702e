#include "lowlap/two_view/internal/line_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lowlap/core/internal/random.h"
#include "two_view/line_scene.h"

namespace lowlap {
namespace {

using testing::MakeSegment;

constexpr double kFocal = 1000;

// Two segments of one view that meet at a corner, `gap` (normalised) apart.
NormalizedFeatures Corner(const Vec3& corner, double gap, double turn_rad) {
  NormalizedFeatures features;
  features.focal_px = kFocal;
  const Vec3 along(1, 0, 0), up(std::cos(turn_rad), std::sin(turn_rad), 0);
  features.segments = {
      MakeSegment(corner + gap * along, corner + (0.2 + gap) * along),
      MakeSegment(corner + gap * up, corner + (0.2 + gap) * up)};
  return features;
}

const std::vector<FeatureMatch> kBoth = {{0, 0}, {1, 1}};

TEST(FindLineCrossings, FindsTheCornerInBothViews) {
  const Vec3 corner1(0.1, 0.2, 1), corner2(-0.3, 0.1, 1);
  const auto crossings = FindLineCrossings(Corner(corner1, 0.01, 1.5),
                                           Corner(corner2, 0.02, 1.2), kBoth);
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_LT((crossings[0].x1 - corner1).norm(), 1e-12);
  EXPECT_LT((crossings[0].x2 - corner2).norm(), 1e-12);
}

TEST(FindLineCrossings, LeavesOutWhatMeetsFarFromTheSegments) {
  const Vec3 corner(0, 0, 1);
  EXPECT_TRUE(
      FindLineCrossings(Corner(corner, 0.1, 1.5), Corner(corner, 0, 1.5), kBoth)
          .empty());
}

TEST(FindLineCrossings, LeavesOutAlmostParallelLines) {
  const Vec3 corner(0, 0, 1);
  EXPECT_TRUE(
      FindLineCrossings(Corner(corner, 0, 0.3), Corner(corner, 0, 1.5), kBoth)
          .empty());
}

TEST(FindLineCrossings, KeepsAFewPerLine) {
  // One long segment crossed by many.
  NormalizedFeatures features;
  features.focal_px = kFocal;
  std::vector<FeatureMatch> matches;
  features.segments.push_back(MakeSegment({-0.5, 0, 1}, {0.5, 0, 1}));
  for (int n = 0; n < 20; ++n) {
    const double x = -0.45 + 0.045 * n;
    features.segments.push_back(MakeSegment({x, -0.1, 1}, {x, 0.1, 1}));
  }
  for (FeatureIndex n = 0; n <= 20; ++n) matches.push_back({n, n});
  EXPECT_EQ(FindLineCrossings(features, features, matches).size(), 4u);
}

// The places of the crossings in view 1, in some order.
std::set<std::pair<double, double>> Places(
    const NormalizedFeatures& features1, const NormalizedFeatures& features2,
    const std::vector<FeatureMatch>& matches) {
  std::set<std::pair<double, double>> places;
  for (const LineCrossing& crossing :
       FindLineCrossings(features1, features2, matches)) {
    places.emplace(std::round(1e6 * crossing.x1.x()),
                   std::round(1e6 * crossing.x1.y()));
  }
  return places;
}

TEST(FindLineCrossings, DoesNotDependOnTheOrderOfMatches) {
  // A facade: all lines cross within their segments, none closer than others.
  NormalizedFeatures features;
  features.focal_px = kFocal;
  std::vector<FeatureMatch> matches;
  Random random(1);
  for (FeatureIndex n = 0; n < 20; ++n) {
    const double place = -0.4 + 0.04 * n;
    const double low = random.Uniform(-0.8, -0.5);
    const double high = random.Uniform(0.5, 0.8);
    features.segments.push_back(
        n % 2 == 0 ? MakeSegment({place, low, 1}, {place, high, 1})
                   : MakeSegment({low, place, 1}, {high, place, 1}));
    matches.push_back({n, n});
  }
  const auto places = Places(features, features, matches);
  EXPECT_GT(places.size(), 10u);
  std::reverse(matches.begin(), matches.end());
  EXPECT_EQ(Places(features, features, matches), places);
}

TEST(FindLineCrossings, StatesTheErrorOfTheCrossing) {
  // At the start of both segments, which are orthogonal, the crossing is as
  // good as their end points; in the middle twice that.
  const Vec3 corner(0, 0, 1);
  const double right_angle = kPi / 2;
  const auto at_start = FindLineCrossings(
      Corner(corner, 0, right_angle), Corner(corner, -0.1, right_angle), kBoth);
  ASSERT_EQ(at_start.size(), 1u);
  EXPECT_LT((at_start[0].covariance1 - Mat2::Identity()).norm(), 1e-9);
  EXPECT_LT((at_start[0].covariance2 - 0.5 * Mat2::Identity()).norm(), 1e-9);
}

TEST(FindLineCrossings, HasNoneForNoMatches) {
  EXPECT_TRUE(FindLineCrossings({}, {}, {}).empty());
}

}  // namespace
}  // namespace lowlap
