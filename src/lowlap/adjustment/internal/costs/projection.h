#pragma once

#include <Eigen/Core>
#include <optional>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

using Mat23 = Eigen::Matrix<double, 2, 3>;

/// Can the model see a point there at all? Perspective ones need z > 0.
inline bool IsProjectable(CameraModel model, const Vec3& x_cam) {
  return model == CameraModel::kSpherical ? x_cam.squaredNorm() > 0
                                          : x_cam.z() > 1e-12 * x_cam.norm();
}

/// A panorama is 2 pi round: the difference of two pixels across its seam.
void WrapPanorama(const Intrinsic& shape, Vec2* difference_px);

/// The projection of a point less the pixel at which it is observed, of a
/// panorama the short way round; nullopt for a point that the camera cannot
/// see.
std::optional<Vec2> ProjectionErrorPx(const Intrinsic& intrinsic,
                                      const Vec3& x_cam, const Vec2& pixel_px);

/// Pixel of a point in camera coordinates (as Intrinsic::Project), from the
/// solver's parameters; of `shape` the model and the size of the image count.
Vec2 ProjectPoint(const Intrinsic& shape, const double* parameters,
                  const Vec3& x_cam);

/// The same with its Jacobian by the point.
Vec2 ProjectPoint(const Intrinsic& shape, const double* parameters,
                  const Vec3& x_cam, Mat23* by_point);

/// The same with that by the parameters of the shape's model as well; the other
/// columns are 0.
Vec2 ProjectPoint(
    const Intrinsic& shape, const double* parameters, const Vec3& x_cam,
    Mat23* by_point,
    Eigen::Matrix<double, 2, kMaxIntrinsicParameters>* by_intrinsic);

}  // namespace lowlap
