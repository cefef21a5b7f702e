#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// The viewing ray of a segment's end point, (x, y, 1) for perspective models,
/// with its derivatives, which say what a distance on the ray is in raw pixels.
struct EndPointRay {
  Vec3 ray = Vec3::Zero();
  Eigen::Matrix<double, 3, 2> by_pixel = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix<double, 3, kMaxIntrinsicParameters> by_intrinsic =
      Eigen::Matrix<double, 3, kMaxIntrinsicParameters>::Zero();
};

struct SegmentRays {
  std::array<EndPointRay, 2> ends;
  Vec3 normal = Vec3::Zero();  // of the interpretation plane, unit
};

/// nullopt: an end point cannot be undistorted, or the segment has no length.
std::optional<SegmentRays> MakeSegmentRays(const LineSegment& segment,
                                           const IntrinsicState& intrinsic,
                                           bool with_intrinsic_derivatives);

/// Distance in pixels of an end point from the image of a line, whose
/// interpretation plane has the normal n (any length) in the camera:
///   r = n . e / | J^T n |,   J = de / dpixel,
/// exact without distortion (fx and fy each count), of first order with it.
/// `by_normal` (1 x 3) may be null.
double EndPointDistancePx(const EndPointRay& end, const Vec3& normal,
                          Eigen::RowVector3d* by_normal);

}  // namespace lowlap
