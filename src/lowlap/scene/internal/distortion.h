#pragma once

#include <cmath>

#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// Distort for plain numbers and dual ones: undistorted (x, y) -> distorted.
/// `k` holds the model's coefficients.
template <class T>
void DistortPoint(CameraModel model, const T* k, const T& x, const T& y,
                  T* x_distorted, T* y_distorted) {
  using std::atan;
  using std::sqrt;
  const T r2 = x * x + y * y;
  T radial = T(1);
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
      *x_distorted = x * radial + k[4] * (r2 + 2.0 * x * x) + 2.0 * k[3] * xy;
      *y_distorted = y * radial + k[3] * (r2 + 2.0 * y * y) + 2.0 * k[4] * xy;
      return;
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
  *x_distorted = x * radial;
  *y_distorted = y * radial;
}

}  // namespace lowlap
