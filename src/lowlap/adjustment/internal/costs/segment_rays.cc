#include "lowlap/adjustment/internal/costs/segment_rays.h"

#include <cmath>

namespace lowlap {
namespace {

std::optional<Vec3> Ray(const Intrinsic& intrinsic, const Vec2& pixel_px) {
  if (intrinsic.model == CameraModel::kSpherical) {
    return intrinsic.Bearing(pixel_px);
  }
  const std::optional<Vec2> point = intrinsic.Normalize(pixel_px);
  if (!point) return std::nullopt;
  return Vec3(point->homogeneous());
}

std::optional<EndPointRay> MakeEndPointRay(const Vec2& pixel_px,
                                           const IntrinsicState& intrinsic,
                                           bool with_intrinsic_derivatives) {
  const Intrinsic& value = intrinsic.value;
  const std::optional<Vec3> ray = Ray(value, pixel_px);
  if (!ray) return std::nullopt;
  EndPointRay end;
  end.ray = *ray;
  constexpr double kPixelStep = 0.1;
  for (int axis = 0; axis < 2; ++axis) {
    Vec2 step = Vec2::Zero();
    step(axis) = kPixelStep;
    const std::optional<Vec3> forward = Ray(value, pixel_px + step);
    const std::optional<Vec3> backward = Ray(value, pixel_px - step);
    if (!forward || !backward) return std::nullopt;
    end.by_pixel.col(axis) = (*forward - *backward) / (2 * kPixelStep);
  }
  if (!with_intrinsic_derivatives) return end;
  for (int n = 0; n < intrinsic.ParameterCount(); ++n) {
    // Focal lengths and principal point are pixels, coefficients are near 0.
    const double step = n < 4 ? 0.1 : 1e-5;
    Vec3 rays[2];
    for (int side = 0; side < 2; ++side) {
      IntrinsicState moved = intrinsic;
      moved.parameters[n] += side == 0 ? step : -step;
      moved.ValueFromParameters();
      const std::optional<Vec3> moved_ray = Ray(moved.value, pixel_px);
      if (!moved_ray) return std::nullopt;
      rays[side] = *moved_ray;
    }
    end.by_intrinsic.col(n) = (rays[0] - rays[1]) / (2 * step);
  }
  return end;
}

}  // namespace

std::optional<SegmentRays> MakeSegmentRays(const LineSegment& segment,
                                           const IntrinsicState& intrinsic,
                                           bool with_intrinsic_derivatives) {
  const std::optional<EndPointRay> start =
      MakeEndPointRay(segment.start_px, intrinsic, with_intrinsic_derivatives);
  const std::optional<EndPointRay> end =
      MakeEndPointRay(segment.end_px, intrinsic, with_intrinsic_derivatives);
  if (!start || !end) return std::nullopt;
  const Vec3 normal = start->ray.cross(end->ray);
  if (!(normal.norm() > 1e-9 * start->ray.norm() * end->ray.norm())) {
    return std::nullopt;
  }
  return SegmentRays{{*start, *end}, normal.normalized()};
}

double EndPointDistancePx(const EndPointRay& end, const Vec3& normal,
                          Eigen::RowVector3d* by_normal) {
  const Vec2 gradient = end.by_pixel.transpose() * normal;
  const double length = gradient.norm(), product = normal.dot(end.ray);
  if (!(length > 0)) {
    if (by_normal != nullptr) by_normal->setZero();
    return 0;
  }
  if (by_normal != nullptr) {
    *by_normal = end.ray.transpose() / length -
                 (product / (length * length * length)) *
                     (end.by_pixel * gradient).transpose();
  }
  return product / length;
}

}  // namespace lowlap
