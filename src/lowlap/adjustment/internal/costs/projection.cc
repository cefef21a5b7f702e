#include "lowlap/adjustment/internal/costs/projection.h"

#include <ceres/jet.h>

#include <array>
#include <cmath>

#include "lowlap/scene/internal/distortion.h"

namespace lowlap {
namespace {

template <class T>
void Project(const Intrinsic& shape, const T* parameters, const T* x_cam,
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
  DistortPoint(shape.model, parameters + 4, T(x_cam[0] / x_cam[2]),
               T(x_cam[1] / x_cam[2]), &x, &y);
  pixel_px[0] = parameters[0] * x + parameters[2];
  pixel_px[1] = parameters[1] * y + parameters[3];
}

// With `Size` derivatives: by the point, then by the parameters.
template <int Size>
Vec2 ProjectWithJacobian(const Intrinsic& shape, const double* values,
                         const Vec3& x_cam,
                         Eigen::Matrix<double, 2, Size>* jacobian) {
  using Jet = ceres::Jet<double, Size>;
  const int count = 4 + static_cast<int>(shape.distortion.size());
  std::array<Jet, kMaxIntrinsicParameters> parameters;
  for (int n = 0; n < count; ++n) {
    parameters[n] = Size > 3 ? Jet(values[n], 3 + n) : Jet(values[n]);
  }
  const Jet x[3] = {Jet(x_cam.x(), 0), Jet(x_cam.y(), 1), Jet(x_cam.z(), 2)};
  Jet pixel[2];
  Project(shape, parameters.data(), x, pixel);
  jacobian->row(0) = pixel[0].v.transpose();
  jacobian->row(1) = pixel[1].v.transpose();
  return {pixel[0].a, pixel[1].a};
}

}  // namespace

void WrapPanorama(const Intrinsic& shape, Vec2* difference_px) {
  if (shape.model != CameraModel::kSpherical) return;
  const double turn = 2 * kPi * shape.MeanFocalPx();
  difference_px->x() -= turn * std::round(difference_px->x() / turn);
}

std::optional<Vec2> ProjectionErrorPx(const Intrinsic& intrinsic,
                                      const Vec3& x_cam, const Vec2& pixel_px) {
  if (!IsProjectable(intrinsic.model, x_cam)) return std::nullopt;
  Vec2 difference_px = intrinsic.Project(x_cam) - pixel_px;
  WrapPanorama(intrinsic, &difference_px);
  if (!difference_px.allFinite()) return std::nullopt;
  return difference_px;
}

Vec2 ProjectPoint(const Intrinsic& shape, const double* parameters,
                  const Vec3& x_cam) {
  Vec2 pixel_px;
  Project(shape, parameters, x_cam.data(), pixel_px.data());
  return pixel_px;
}

Vec2 ProjectPoint(const Intrinsic& shape, const double* parameters,
                  const Vec3& x_cam, Mat23* by_point) {
  if (shape.model != CameraModel::kPinhole) {
    return ProjectWithJacobian<3>(shape, parameters, x_cam, by_point);
  }
  const double* k = parameters;
  const double inverse_z = 1 / x_cam.z();
  const double x = x_cam.x() * inverse_z, y = x_cam.y() * inverse_z;
  *by_point << k[0] * inverse_z, 0, -k[0] * inverse_z * x,  //
      0, k[1] * inverse_z, -k[1] * inverse_z * y;
  return {k[0] * x + k[2], k[1] * y + k[3]};
}

Vec2 ProjectPoint(
    const Intrinsic& shape, const double* parameters, const Vec3& x_cam,
    Mat23* by_point,
    Eigen::Matrix<double, 2, kMaxIntrinsicParameters>* by_intrinsic) {
  Eigen::Matrix<double, 2, 3 + kMaxIntrinsicParameters> jacobian;
  const Vec2 pixel_px =
      ProjectWithJacobian(shape, parameters, x_cam, &jacobian);
  *by_point = jacobian.leftCols<3>();
  *by_intrinsic = jacobian.rightCols<kMaxIntrinsicParameters>();
  return pixel_px;
}

}  // namespace lowlap
