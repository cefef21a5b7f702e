#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap::internal {

/// Undistorted (x, y) -> distorted, as lowlap::Distort, for plain numbers and
/// dual ones.
template <class T>
void DistortPoint(CameraModel model, const T* k, const T& x, const T& y,
                  T* x_distorted, T* y_distorted) {
  using std::atan;
  using std::sqrt;
  const T r2 = x * x + y * y;
  T radial = T(1), dx = T(0), dy = T(0);
  switch (model) {
    case CameraModel::kPinhole:
    case CameraModel::kSpherical:
      break;
    case CameraModel::kRadialK1:
      radial = 1.0 + k[0] * r2;
      break;
    case CameraModel::kRadialK3:
      radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
      break;
    case CameraModel::kBrownT2: {
      radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
      const T xy = x * y;
      dx = k[4] * (r2 + 2.0 * x * x) + 2.0 * k[3] * xy;
      dy = k[3] * (r2 + 2.0 * y * y) + 2.0 * k[4] * xy;
      break;
    }
    case CameraModel::kFisheye: {
      // theta_d / r, with its limit at the axis: theta/r = 1 - r^2/3 + ...
      if (r2 < T(1e-16)) {
        radial = 1.0 - r2 / 3.0 + k[0] * r2;
        break;
      }
      const T r = sqrt(r2);
      const T theta = atan(r), t2 = theta * theta;
      radial = theta *
               (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))) / r;
      break;
    }
  }
  *x_distorted = x * radial + dx;
  *y_distorted = y * radial + dy;
}

/// Pixel of a point in camera coordinates (as Intrinsic::Project), from the
/// solver's parameters. Width and height matter for panoramas only.
template <class T>
void ProjectPoint(const Intrinsic& shape, const T* intrinsic, const T* x_cam,
                  T* pixel_px) {
  using std::atan2;
  using std::sqrt;
  if (shape.model == CameraModel::kSpherical) {
    const double per_radian = shape.MeanFocalPx();
    const T lon = atan2(x_cam[0], x_cam[2]);
    const T lat =
        atan2(-x_cam[1], sqrt(x_cam[0] * x_cam[0] + x_cam[2] * x_cam[2]));
    pixel_px[0] = lon * per_radian + 0.5 * shape.width_px;
    pixel_px[1] = 0.5 * shape.height_px - lat * per_radian;
    return;
  }
  T x, y;
  DistortPoint(shape.model, intrinsic + 4, T(x_cam[0] / x_cam[2]),
               T(x_cam[1] / x_cam[2]), &x, &y);
  pixel_px[0] = intrinsic[0] * x + intrinsic[2];
  pixel_px[1] = intrinsic[1] * y + intrinsic[3];
}

/// Can the model see a point there at all? Perspective ones need z > 0.
inline bool IsProjectable(CameraModel model, const Vec3& x_cam) {
  return model == CameraModel::kSpherical ? x_cam.squaredNorm() > 0
                                          : x_cam.z() > 1e-12 * x_cam.norm();
}

/// A panorama is 2 pi round: the difference of two pixels across its seam.
inline void WrapPanorama(const Intrinsic& shape, Vec2* difference_px) {
  if (shape.model != CameraModel::kSpherical) return;
  const double turn = 2 * kPi * shape.MeanFocalPx();
  difference_px->x() -= turn * std::round(difference_px->x() / turn);
}

using Mat23 = Eigen::Matrix<double, 2, 3>;

/// Projection with its Jacobian by the point; nullopt where IsProjectable is
/// false.
inline std::optional<Vec2> ProjectWithJacobian(const IntrinsicState& intrinsic,
                                               const Vec3& x_cam,
                                               Mat23* jacobian) {
  if (!IsProjectable(intrinsic.value.model, x_cam)) return std::nullopt;
  if (intrinsic.value.model == CameraModel::kPinhole) {
    const IntrinsicParameters& k = intrinsic.parameters;
    const double inverse_z = 1 / x_cam.z();
    const double x = x_cam.x() * inverse_z, y = x_cam.y() * inverse_z;
    *jacobian << k[0] * inverse_z, 0, -k[0] * inverse_z * x,  //
        0, k[1] * inverse_z, -k[1] * inverse_z * y;
    return Vec2(k[0] * x + k[2], k[1] * y + k[3]);
  }
  using Jet = ceres::Jet<double, 3>;
  std::array<Jet, kMaxIntrinsicParameters> parameters;
  for (int n = 0; n < kMaxIntrinsicParameters; ++n) {
    parameters[n] = Jet(intrinsic.parameters[n]);
  }
  const Jet x[3] = {Jet(x_cam.x(), 0), Jet(x_cam.y(), 1), Jet(x_cam.z(), 2)};
  Jet pixel[2];
  ProjectPoint(intrinsic.value, parameters.data(), x, pixel);
  jacobian->row(0) = pixel[0].v.transpose();
  jacobian->row(1) = pixel[1].v.transpose();
  return Vec2(pixel[0].a, pixel[1].a);
}

}  // namespace lowlap::internal
