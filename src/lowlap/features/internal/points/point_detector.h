#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/features/feature_options.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// How the localisation error of a keypoint is shaped: the inverse of the
/// structure tensor sum g g^T of the gradients around it (Förstner & Gülch
/// 1987), over a window that follows its scale (standard deviation of the
/// blob), scaled such that the better direction has variance 1. A corner has
/// the identity; a blob on the grain of wood, or where an edge ends, is far
/// less certain along the edge. At most 100 (a tenfold deviation). The identity
/// where the image is flat.
Mat2 LocalizationCovariance(const GrayImage& image, const Vec2& position_px,
                            double scale_px);

/// Root-SIFT (Arandjelovic & Zisserman 2012): the square root of the
/// L1-normalised SIFT descriptor, a unit vector, times 512, rounded and cut off
/// at 255. Euclidean distances are exact in integers.
using PointDescriptor = std::array<std::uint8_t, 128>;

struct Keypoint {
  Vec2 position_px = Vec2::Zero();  // centre of the top-left pixel: (0, 0)
  double scale_px = 0;              // standard deviation of the blob
  double angle_rad = 0;             // dominant gradient direction, x to y
  /// Shape of the error of the position (LocalizationCovariance).
  Mat2 covariance = Mat2::Identity();
  double tilt = 1;  // of the image that it was found in (TiltImage)
};

struct PointFeatures {
  std::vector<Keypoint> keypoints;
  std::vector<PointDescriptor> descriptors;  // one per keypoint
};

/// Raised whenever keypoints or descriptors change for the same input and
/// options: what is cached is then computed anew.
inline constexpr int kPointDetectorVersion = 3;

/// SIFT keypoints (Lowe 2004, by OpenCV) with root-SIFT descriptors, sorted by
/// position; the same for any number of threads. When there are more than
/// `max_points`, three quarters of the selection are the strongest, and the
/// rest is shared out evenly, so that no part of the image is starved. An image
/// without texture, or too small for SIFT, has no keypoints.
Result<PointFeatures> DetectPoints(const GrayImage& image,
                                   const PointOptions& options);

}  // namespace lowlap
