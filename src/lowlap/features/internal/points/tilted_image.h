#pragma once

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/features/internal/points/point_detector.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// An image compressed along one direction, as a surface appears in it that is
/// turned away from the camera.
struct TiltedImage {
  GrayImage image;
  /// position in `image` = linear * position + offset_px.
  Mat2 linear = Mat2::Identity();
  Vec2 offset_px = Vec2::Zero();
};

/// Turns the image by `turn_rad` (x to y), scales it by `scale` (<= 1), and
/// compresses it along x by `tilt` (>= 1). A blur of standard deviation
/// 0.8 (tilt^2 - 1)^(1/2) along x before keeps it free of aliasing (Morel & Yu,
/// ASIFT, SIAM J. Imaging Sciences 2009). All of the image is in it; around it
/// its outermost pixels go on. Errors: those of OpenCV.
Result<TiltedImage> TiltImage(const GrayImage& image, double scale, double tilt,
                              double turn_rad);

/// A keypoint of a tilted image in the image itself: scale_px is the geometric
/// mean of the blob's axes there.
Keypoint Untilted(const Keypoint& keypoint, const TiltedImage& tilted);

}  // namespace lowlap
