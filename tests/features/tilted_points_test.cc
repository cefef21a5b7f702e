#include "lowlap/features/internal/points/tilted_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

constexpr int kSide = 200;

GrayImage Texture() {
  return testing::Render(kSide, kSide, testing::BlobTexture(5, 200, kSide));
}

Result<TiltedPoints> Detect(const GrayImage& image, const TiltOptions& tilts,
                            const RunContext& context = {}) {
  return DetectTiltedPoints(image, DetectPoints(image, {}).value(), {}, tilts,
                            context);
}

TEST(DetectTiltedPointsTest, StartsWithTheImageItself) {
  const GrayImage image = Texture();
  const PointFeatures untilted = DetectPoints(image, {}).value();
  TiltOptions none;
  none.max_tilt = 1;
  const auto points = Detect(image, none);
  ASSERT_THAT(points, IsOk());
  ASSERT_EQ(points->looks.size(), 1u);
  EXPECT_EQ(points->looks[0].descriptors, untilted.descriptors);
  for (FeatureIndex n = 0; n < untilted.keypoints.size(); ++n) {
    EXPECT_EQ(points->looks[0].points[n], n);
  }
  EXPECT_TRUE(points->added.keypoints.empty());
}

TEST(DetectTiltedPointsTest, LooksFromMoreSidesTheGreaterTheTilt) {
  TiltOptions tilts;
  tilts.max_tilt = 2;
  const auto points = Detect(Texture(), tilts);
  ASSERT_THAT(points, IsOk());
  // Every 51 degrees (a quarter of 180 is 45) and every 36.
  EXPECT_EQ(points->looks.size(), 1u + 4u + 5u);
}

TEST(DetectTiltedPointsTest, CountsNoPlaceTwice) {
  const GrayImage image = Texture();
  const PointFeatures untilted = DetectPoints(image, {}).value();
  const auto points = Detect(image, {});
  ASSERT_THAT(points, IsOk());
  std::vector<Keypoint> all = untilted.keypoints;
  EXPECT_EQ(points->added.keypoints.size(), points->added.descriptors.size());
  int shared = 0;
  for (const TiltedPoints::Look& look : points->looks) {
    ASSERT_EQ(look.points.size(), look.descriptors.size());
    shared += static_cast<int>(std::count_if(
        look.points.begin(), look.points.end(),
        [&](auto point) { return point < untilted.keypoints.size(); }));
  }
  // Most of what one sees from aside shows in the image itself.
  EXPECT_GT(shared, 4 * static_cast<int>(untilted.keypoints.size()));
  for (const Keypoint& keypoint : points->added.keypoints) {
    EXPECT_GT(keypoint.tilt, 1);
    for (const Keypoint& other : all) {
      const bool same_scale = keypoint.scale_px < 1.5 * other.scale_px &&
                              other.scale_px < 1.5 * keypoint.scale_px;
      EXPECT_FALSE(same_scale &&
                   (keypoint.position_px - other.position_px).norm() <
                       std::max(1.0, 0.25 * keypoint.scale_px));
    }
    all.push_back(keypoint);
    const double border_px = 2 * keypoint.scale_px;
    EXPECT_GE(keypoint.position_px.minCoeff(), border_px);
    EXPECT_LE(keypoint.position_px.maxCoeff(), kSide - 1 - border_px);
  }
}

TEST(DetectTiltedPointsTest, ReducesLargeImages) {
  TiltOptions tilts;
  const auto whole = Detect(Texture(), tilts);
  tilts.max_side_px = kSide / 2;
  const auto reduced = Detect(Texture(), tilts);
  ASSERT_THAT(whole, IsOk());
  ASSERT_THAT(reduced, IsOk());
  EXPECT_EQ(whole->looks.size(), reduced->looks.size());
  EXPECT_LT(reduced->looks[1].points.size(),
            0.9 * whole->looks[1].points.size());
  EXPECT_GT(reduced->looks[1].points.size(), 0u);
}

TEST(DetectTiltedPointsTest, DoesNotDependOnThreadsAndStopsOnRequest) {
  RunContext context;
  context.num_threads = 1;
  const auto one = Detect(Texture(), {}, context);
  context.num_threads = 4;
  const auto four = Detect(Texture(), {}, context);
  ASSERT_THAT(one, IsOk());
  ASSERT_THAT(four, IsOk());
  ASSERT_EQ(one->looks.size(), four->looks.size());
  for (std::size_t n = 0; n < one->looks.size(); ++n) {
    EXPECT_EQ(one->looks[n].points, four->looks[n].points);
    EXPECT_EQ(one->looks[n].descriptors, four->looks[n].descriptors);
  }
  context.progress = [](const std::string&, std::size_t done, std::size_t) {
    return done < 3;
  };
  EXPECT_THAT(Detect(Texture(), {}, context),
              IsError(ErrorCode::kCancelled, "tilted"));
}

TEST(DetectTiltedPointsTest, RefusesOptionsOutOfRange) {
  TiltOptions tilts;
  tilts.max_tilt = 0.5;
  EXPECT_THAT(Detect(Texture(), tilts),
              IsError(ErrorCode::kInvalidArgument, "max_tilt"));
  tilts = {};
  tilts.max_side_px = 8;
  EXPECT_THAT(Detect(Texture(), tilts),
              IsError(ErrorCode::kInvalidArgument, "max_side_px"));
  tilts = {};
  tilts.max_points = 0;
  EXPECT_THAT(tilts.Validate(),
              IsError(ErrorCode::kInvalidArgument, "max_points of tilts"));
}

}  // namespace
}  // namespace lowlap
