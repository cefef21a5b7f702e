#include "lowlap/matching/internal/points/tilted_matching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/points/point_matching.h"
#include "support/matchers.h"
#include "support/synthetic_image.h"
#include "tests/matching/pattern_view.h"

namespace lowlap {
namespace {

using testing::BlobTexture;
using testing::IsError;
using ::testing::IsSubsetOf;

constexpr int kSide = 260;

/// An image with what it shows from aside.
struct SeenFromAside {
  DetectedFeatures features;
  TiltedPoints tilted;
  std::vector<PointDescriptor> untilted;

  explicit SeenFromAside(const GrayImage& image) {
    const PointFeatures points = DetectPoints(image, {}).value();
    untilted = points.descriptors;
    tilted = DetectTiltedPoints(image, points, {}, {}, {}).value();
    AddPoints(points, &features);
    AddPoints(tilted.added, &features);
  }
  TiltedView view() const { return {features.keypoints, tilted.looks}; }
};

/// A texture, and the same compressed along x as a wall seen from aside.
struct Slanted {
  static constexpr double kTilt = 3.5;
  BlobTexture texture{8, 260, kSide};
  SeenFromAside frontal{testing::Render(kSide, kSide, texture)};
  SeenFromAside slanted{testing::Render(
      static_cast<int>(kSide / kTilt) + 1, kSide,
      [this](const Vec2& p) { return texture(Vec2(kTilt * p.x(), p.y())); })};

  int CountRight(const std::vector<FeatureMatch>& matches) const {
    int right = 0;
    for (const FeatureMatch& match : matches) {
      const Vec2 from = frontal.features.keypoints[match.first].position_px;
      const Vec2 to = slanted.features.keypoints[match.second].position_px;
      right += (from - Vec2(kTilt * to.x(), to.y())).norm() < 4;
    }
    return right;
  }
};

TEST(MatchTiltedPointsTest, FindsWhatAWallShowsFromAside) {
  const Slanted pair;
  const auto untilted =
      MatchPoints(pair.frontal.untilted, pair.slanted.untilted, {});
  const auto matches =
      MatchTiltedPoints(pair.frontal.view(), pair.slanted.view(), untilted, {});
  EXPECT_THAT(untilted, IsSubsetOf(matches));
  const int right = pair.CountRight(matches);
  EXPECT_GT(right, 30);
  EXPECT_GT(right, 4 * pair.CountRight(untilted));
  EXPECT_GT(right, 0.8 * matches.size());
}

TEST(MatchTiltedPointsTest, MatchesEveryPlaceOnce) {
  const Slanted pair;
  const auto matches =
      MatchTiltedPoints(pair.frontal.view(), pair.slanted.view(), {}, {});
  ASSERT_GT(matches.size(), 10u);
  EXPECT_TRUE(std::is_sorted(matches.begin(), matches.end()));
  for (std::size_t a = 0; a < matches.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const auto distance = [&](const SeenFromAside& side, FeatureIndex i,
                                FeatureIndex j) {
        return (side.features.keypoints[i].position_px -
                side.features.keypoints[j].position_px)
            .norm();
      };
      EXPECT_GE(distance(pair.frontal, matches[a].first, matches[b].first), 4);
      EXPECT_GE(distance(pair.slanted, matches[a].second, matches[b].second),
                4);
    }
  }
}

TEST(MatchTiltedPointsTest, IsTheSameFromEitherSide) {
  const Slanted pair;
  const auto forward =
      MatchTiltedPoints(pair.frontal.view(), pair.slanted.view(), {}, {});
  const auto backward =
      MatchTiltedPoints(pair.slanted.view(), pair.frontal.view(), {}, {});
  const int right = pair.CountRight(forward);
  std::vector<FeatureMatch> swapped;
  for (const FeatureMatch& match : backward) {
    swapped.push_back({match.second, match.first});
  }
  EXPECT_NEAR(pair.CountRight(swapped), right, 0.15 * right);
}

/// Points 100 px apart, each of which all of three looks show.
struct DrawnView {
  std::vector<Keypoint> keypoints;
  std::vector<TiltedPoints::Look> looks{3};

  DrawnView(const std::vector<PointDescriptor>& descriptors,
            std::uint64_t seed) {
    Random random(seed);
    for (FeatureIndex n = 0; n < descriptors.size(); ++n) {
      keypoints.emplace_back();
      keypoints.back().position_px = Vec2(100 * n, 50);
      keypoints.back().scale_px = 2;
      for (TiltedPoints::Look& look : looks) {
        look.points.push_back(n);
        look.descriptors.push_back(
            testing::Resembling(descriptors[n], &random));
      }
    }
  }
  TiltedView view() const { return {keypoints, looks}; }
};

TEST(MatchTiltedPointsTest, APlaceIsNoRivalOfItselfButAnotherThatLooksAlikeIs) {
  Random random(2);
  std::vector<PointDescriptor> descriptors;
  for (int n = 0; n < 6; ++n) {
    descriptors.push_back(testing::RandomDescriptor(&random));
  }
  const DrawnView first(descriptors, 1);
  descriptors.push_back(descriptors[2]);  // once more, elsewhere
  const DrawnView second(descriptors, 2);
  const std::vector<FeatureMatch> expected = {
      {0, 0}, {1, 1}, {3, 3}, {4, 4}, {5, 5}};
  EXPECT_EQ(MatchTiltedPoints(first.view(), second.view(), {}, {}), expected);
}

TEST(MatchTiltedPointsTest, OfBlobsThatOverlapOneCounts) {
  Random random(2);
  std::vector<PointDescriptor> descriptors;
  for (int n = 0; n < 4; ++n) {
    descriptors.push_back(testing::RandomDescriptor(&random));
  }
  DrawnView first(descriptors, 1), second(descriptors, 2);
  // Blobs of this scale overlap within 12 px.
  for (DrawnView* view : {&first, &second}) {
    view->keypoints[1].position_px = view->keypoints[0].position_px;
    view->keypoints[1].position_px.x() += 10;
    view->keypoints[0].scale_px = view->keypoints[1].scale_px = 6;
  }
  EXPECT_EQ(MatchTiltedPoints(first.view(), second.view(), {}, {}).size(), 3u);
  // Those that are there already come first.
  EXPECT_THAT(MatchTiltedPoints(first.view(), second.view(), {{1, 1}}, {}),
              ::testing::ElementsAre(FeatureMatch{1, 1}, FeatureMatch{2, 2},
                                     FeatureMatch{3, 3}));
}

TEST(MatchTiltedPointsTest, ViewsWithoutPointsHaveNoMatches) {
  const SeenFromAside empty(testing::Uniform(100, 100, 80));
  const Slanted pair;
  EXPECT_TRUE(
      MatchTiltedPoints(empty.view(), pair.frontal.view(), {}, {}).empty());
  EXPECT_TRUE(
      MatchTiltedPoints(pair.frontal.view(), empty.view(), {}, {}).empty());
}

TEST(TiltedPointOptionsTest, RejectsValuesOutOfRange) {
  TiltedPointOptions options;
  options.starved_below = -1;
  EXPECT_THAT(options.Validate(),
              IsError(ErrorCode::kInvalidArgument, "starved_below"));
  options = {};
  options.max_ratio = 0;
  EXPECT_THAT(options.Validate(),
              IsError(ErrorCode::kInvalidArgument, "max_ratio"));
}

}  // namespace
}  // namespace lowlap
