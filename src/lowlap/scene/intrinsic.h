#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// The camera models of OpenMVG. All but kSpherical are
///   pixel = (fx x_d + ppx, fy y_d + ppy),  (x_d, y_d) = distort(X/Z, Y/Z);
/// the distortion maps undistorted to distorted normalised coordinates.
enum class CameraModel {
  kPinhole,    // no distortion
  kRadialK1,   // k1
  kRadialK3,   // k1 k2 k3
  kBrownT2,    // k1 k2 k3 t1 t2
  kFisheye,    // k1 k2 k3 k4 (equidistant)
  kSpherical,  // equirectangular panorama; fx, fy, pp unused: 0
};

/// OpenMVG's name of a model ("pinhole_radial_k3", ...), and back.
const char* CameraModelName(CameraModel model);
std::optional<CameraModel> CameraModelFromName(const std::string& name);
/// Number of distortion coefficients of a model.
int DistortionCount(CameraModel model);

/// One camera's interior orientation, in pixels; the centre of the top-left
/// pixel is (0, 0). fx and fy are separate.
struct Intrinsic {
  CameraModel model = CameraModel::kPinhole;
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  Vec2 principal_point_px = Vec2::Zero();
  std::vector<double> distortion;  // DistortionCount(model) coefficients

  /// Pixel of a point in camera coordinates. For perspective models the point
  /// must have z > 0 (the value is meaningless otherwise).
  Vec2 Project(const Vec3& point_in_cam) const;

  /// Unit viewing ray of a pixel: the inverse of Project. nullopt: the pixel
  /// lies outside the range around the axis where the distortion is invertible.
  std::optional<Vec3> Bearing(const Vec2& pixel_px) const;

  /// Undistorted normalised coordinates (X/Z, Y/Z) of a pixel; nullopt as
  /// above, and for rays with z <= 0.
  std::optional<Vec2> Normalize(const Vec2& pixel_px) const;

  /// Geometric mean of fx and fy: pixels per unit of normalised coordinates.
  double MeanFocalPx() const;
  double ImageArea() const { return static_cast<double>(width_px) * height_px; }
  double ImageDiagonal() const;
  bool HasDistortion() const;

  /// Sizes and focals positive and finite (zero for kSpherical), the right
  /// number of coefficients.
  Status Validate() const;

  friend bool operator==(const Intrinsic& a, const Intrinsic& b);
};

/// Undistorted (x, y) -> distorted (x_d, y_d) of the perspective models.
Vec2 Distort(CameraModel model, const std::vector<double>& coefficients,
             const Vec2& undistorted);

}  // namespace lowlap
