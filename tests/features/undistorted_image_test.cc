#include "lowlap/features/internal/undistorted_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lowlap/features/internal/features.h"
#include "lowlap/scene/features.h"
#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::Render;

struct Lens {
  CameraModel model;
  std::vector<double> distortion;
};

Intrinsic MakeIntrinsic(const Lens& lens) {
  Intrinsic intrinsic;
  intrinsic.model = lens.model;
  intrinsic.distortion = lens.distortion;
  intrinsic.width_px = 600;
  intrinsic.height_px = 400;
  intrinsic.fx_px = 400;
  intrinsic.fy_px = 410;
  intrinsic.principal_point_px = {305, 196};
  return intrinsic;
}

std::vector<Lens> Lenses() {
  return {{CameraModel::kRadialK1, {-0.2}},
          {CameraModel::kRadialK3, {0.15, -0.02, 0.01}},
          {CameraModel::kBrownT2, {-0.15, 0.02, 0, 0.004, -0.003}},
          {CameraModel::kFisheye, {0.02, -0.01, 0.003, -0.0005}}};
}

// A bright tilted rectangle in normalised coordinates, as the lens shows it.
const std::vector<Vec2> kCorners = {
    {-0.52, 0.33}, {0.45, 0.38}, {0.5, -0.3}, {-0.42, -0.36}};

GrayImage Photograph(const Intrinsic& intrinsic) {
  return Render(intrinsic.width_px, intrinsic.height_px, [&](const Vec2& p) {
    const std::optional<Vec2> ray = intrinsic.Normalize(p);
    return 60 +
           120 * (ray ? testing::PolygonCover(*ray, kCorners, 0.002) : 0.0);
  });
}

// Largest distance, in pixels of the pinhole, of the end points of a segment
// from the nearest side of the rectangle; seen from the segment's own ends.
double DistanceFromSides(const LineSegment& segment, const Intrinsic& lens,
                         int* side) {
  const NormalizedSegment s = NormalizeSegment(segment, lens);
  double best = 1e9;
  for (int n = 0; n < 4; ++n) {
    const Vec2 a = kCorners[n], b = kCorners[(n + 1) % 4];
    const Vec3 line = a.homogeneous().cross(b.homogeneous());
    const double scale = lens.fx_px / line.head<2>().norm();
    const double distance = std::max(std::abs(line.dot(s.start)) * scale,
                                     std::abs(line.dot(s.end)) * scale);
    if (distance < best) best = distance, *side = n;
  }
  return best;
}

TEST(UndistortedImageTest, CurvedEdgesBecomeOneStraightSegmentEach) {
  FeatureOptions options;
  options.detect_points = false;
  for (const Lens& lens : Lenses()) {
    SCOPED_TRACE(CameraModelName(lens.model));
    const Intrinsic intrinsic = MakeIntrinsic(lens);
    const auto detected =
        DetectFeatures(Photograph(intrinsic), intrinsic, options);
    ASSERT_THAT(detected, IsOk());
    const auto& segments = detected->features.segments;
    ASSERT_GE(segments.size(), 4u);
    EXPECT_EQ(detected->line_descriptors.size(), segments.size());
    std::set<int> sides;
    for (int n = 0; n < 4; ++n) {
      int side = -1;
      EXPECT_LT(DistanceFromSides(segments[n], intrinsic, &side), 0.5);
      sides.insert(side);
      EXPECT_GT(segments[n].LengthPx(), 180);
    }
    EXPECT_EQ(sides.size(), 4u);
  }
}

TEST(UndistortedImageTest, TheCanvasHoldsTheWholePhotograph) {
  const Intrinsic intrinsic = MakeIntrinsic({CameraModel::kRadialK1, {-0.2}});
  const auto undistorted =
      UndistortedImage::Make(testing::Uniform(600, 400, 90), intrinsic);
  ASSERT_THAT(undistorted, IsOk());
  EXPECT_GT(undistorted->image().width, 640);
  EXPECT_LE(undistorted->image().width, 1200);
  for (const std::uint8_t value : undistorted->image().pixels) {
    ASSERT_EQ(value, 90);  // no edge where the photograph ends
  }
}

TEST(UndistortedImageTest, SegmentsAreCutWhereThePhotographEnds) {
  const Intrinsic intrinsic = MakeIntrinsic({CameraModel::kRadialK1, {-0.2}});
  const auto undistorted =
      UndistortedImage::Make(testing::Uniform(600, 400, 90), intrinsic);
  ASSERT_THAT(undistorted, IsOk());
  const double w = undistorted->image().width, h = undistorted->image().height;
  // Along the top edge of the canvas, which bends out of the photograph.
  const auto whole = undistorted->ToDistorted({{0, h / 2}, {w, h / 2}, 0.5});
  ASSERT_TRUE(whole);
  EXPECT_NEAR(whole->start_px.x(), 0, 1.5);
  EXPECT_NEAR(whole->end_px.x(), 599, 1.5);
  for (const Vec2& end : {whole->start_px, whole->end_px}) {
    EXPECT_GE(end.x(), 0);
    EXPECT_LE(end.x(), 599);
  }
  EXPECT_FALSE(undistorted->ToDistorted({{w / 2, -20}, {w / 2 + 30, -20}, 1}));
}

TEST(UndistortedImageTest, WithoutDistortionNothingChanges) {
  const GrayImage image =
      Photograph(MakeIntrinsic({CameraModel::kPinhole, {}}));
  const Intrinsic zero = MakeIntrinsic({CameraModel::kRadialK1, {0}});
  const auto plain = DetectFeatures(image, {});
  const auto with = DetectFeatures(image, zero, {});
  ASSERT_THAT(with, IsOk());
  EXPECT_TRUE(plain->features == with->features);
}

TEST(UndistortedImageTest, WhatNoPinholeShowsIsRefused) {
  Intrinsic panorama;
  panorama.model = CameraModel::kSpherical;
  panorama.width_px = 600;
  panorama.height_px = 400;
  const GrayImage image =
      Photograph(MakeIntrinsic({CameraModel::kPinhole, {}}));
  EXPECT_THAT(UndistortedImage::Make(image, panorama),
              IsError(ErrorCode::kUnsupported, "panorama"));
  const auto detected = DetectFeatures(image, panorama, {});
  ASSERT_THAT(detected, IsOk());
  EXPECT_TRUE(detected->features.segments.empty());
  Intrinsic other = MakeIntrinsic({CameraModel::kRadialK1, {-0.1}});
  other.width_px = 601;
  EXPECT_THAT(UndistortedImage::Make(image, other),
              IsError(ErrorCode::kInvalidArgument, "size"));
}

}  // namespace
}  // namespace lowlap
