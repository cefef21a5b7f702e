#pragma once

#include <optional>
#include <utility>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// The photograph that a pinhole camera with the same focal lengths would have
/// taken: straight lines are straight in it. It covers what the distorted
/// photograph shows, up to twice its width and height about the principal
/// point (a fisheye's margin lies farther out and is left out).
class UndistortedImage {
 public:
  /// By bilinear interpolation (OpenCV). kUnsupported for panoramas, which no
  /// pinhole shows; kInvalidArgument if image and intrinsic differ in size.
  static Result<UndistortedImage> Make(const GrayImage& distorted,
                                       const Intrinsic& intrinsic);

  const GrayImage& image() const { return image_; }

  /// A segment of image() with its end points moved to the photograph's own
  /// pixels, first shortened where it leaves the photograph; its standard
  /// deviation is scaled with the pixels. nullopt if too little is left.
  std::optional<LineSegment> ToDistorted(const LineSegment& segment) const;

 private:
  UndistortedImage(GrayImage image, Intrinsic intrinsic, const Vec2& origin_px)
      : image_(std::move(image)),
        intrinsic_(std::move(intrinsic)),
        origin_px_(origin_px) {}
  Vec2 PixelToDistorted(const Vec2& pixel_px) const;

  GrayImage image_;
  Intrinsic intrinsic_;
  Vec2 origin_px_;  // of the principal point in image_
};

}  // namespace lowlap
