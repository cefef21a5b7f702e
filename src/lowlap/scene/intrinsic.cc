#include "lowlap/scene/intrinsic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lowlap/scene/internal/distortion.h"
#include "lowlap/scene/internal/undistort.h"

namespace lowlap {
namespace {

struct ModelEntry {
  CameraModel model;
  const char* name;
  int distortion_count;
};

constexpr std::array<ModelEntry, 6> kModels = {{
    {CameraModel::kPinhole, "pinhole", 0},
    {CameraModel::kRadialK1, "pinhole_radial_k1", 1},
    {CameraModel::kRadialK3, "pinhole_radial_k3", 3},
    {CameraModel::kBrownT2, "pinhole_brown_t2", 5},
    {CameraModel::kFisheye, "fisheye", 4},
    {CameraModel::kSpherical, "spherical", 0},
}};

const ModelEntry& Entry(CameraModel model) {
  return *std::find_if(kModels.begin(), kModels.end(),
                       [&](const ModelEntry& e) { return e.model == model; });
}

}  // namespace

const char* CameraModelName(CameraModel model) { return Entry(model).name; }

std::optional<CameraModel> CameraModelFromName(const std::string& name) {
  for (const ModelEntry& entry : kModels) {
    if (name == entry.name) return entry.model;
  }
  return std::nullopt;
}

int DistortionCount(CameraModel model) { return Entry(model).distortion_count; }

Vec2 Distort(CameraModel model, const std::vector<double>& k, const Vec2& p) {
  Vec2 distorted;
  DistortPoint(model, k.data(), p.x(), p.y(), &distorted.x(), &distorted.y());
  return distorted;
}

Vec2 Intrinsic::Project(const Vec3& x) const {
  if (model == CameraModel::kSpherical) {
    const double size = std::max(width_px, height_px);
    const double lon = std::atan2(x.x(), x.z());
    const double lat = std::atan2(-x.y(), std::hypot(x.x(), x.z()));
    return {lon / (2 * kPi) * size + 0.5 * width_px,
            -lat / (2 * kPi) * size + 0.5 * height_px};
  }
  const Vec2 d = Distort(model, distortion, x.head<2>() / x.z());
  return Vec2(fx_px * d.x(), fy_px * d.y()) + principal_point_px;
}

std::optional<Vec3> Intrinsic::Bearing(const Vec2& pixel_px) const {
  if (model == CameraModel::kSpherical) {
    const double size = std::max(width_px, height_px);
    const double lon = (pixel_px.x() - 0.5 * width_px) * (2 * kPi) / size;
    const double lat = -(pixel_px.y() - 0.5 * height_px) * (2 * kPi) / size;
    return Vec3(std::cos(lat) * std::sin(lon), -std::sin(lat),
                std::cos(lat) * std::cos(lon));
  }
  const std::optional<Vec2> p = Normalize(pixel_px);
  if (!p) return std::nullopt;
  return Vec3(p->homogeneous().normalized());
}

std::optional<Vec2> Intrinsic::Normalize(const Vec2& pixel_px) const {
  if (model == CameraModel::kSpherical) {
    const std::optional<Vec3> ray = Bearing(pixel_px);
    if (!ray || !(ray->z() > 0)) return std::nullopt;
    return Vec2(ray->head<2>() / ray->z());
  }
  const Vec2 centred = pixel_px - principal_point_px;
  const Vec2 distorted(centred.x() / fx_px, centred.y() / fy_px);
  if (!HasDistortion()) return distorted;
  return Undistort(model, distortion, distorted);
}

double Intrinsic::MeanFocalPx() const {
  // A panorama has 2 pi radians over its width.
  if (model == CameraModel::kSpherical) {
    return std::max(width_px, height_px) / (2 * kPi);
  }
  return std::sqrt(fx_px * fy_px);
}

double Intrinsic::ImageDiagonal() const {
  return std::hypot(static_cast<double>(width_px), height_px);
}

bool Intrinsic::HasDistortion() const {
  if (model == CameraModel::kFisheye) return true;
  return std::any_of(distortion.begin(), distortion.end(),
                     [](double k) { return k != 0; });
}

Status Intrinsic::Validate() const {
  const auto invalid = [](const std::string& message) {
    return MakeError(ErrorCode::kInvalidScene, message);
  };
  if (width_px <= 0 || height_px <= 0) {
    return invalid("image size must be positive");
  }
  if (static_cast<int>(distortion.size()) != DistortionCount(model)) {
    return invalid(std::string(CameraModelName(model)) + " needs " +
                   std::to_string(DistortionCount(model)) +
                   " distortion coefficients, not " +
                   std::to_string(distortion.size()));
  }
  for (const double k : distortion) {
    if (!std::isfinite(k)) return invalid("distortion must be finite");
  }
  if (model == CameraModel::kSpherical) {
    if (fx_px != 0 || fy_px != 0 || principal_point_px != Vec2::Zero()) {
      return invalid(
          "spherical has no focal length or principal point: leave them 0");
    }
    return {};
  }
  if (!(fx_px > 0) || !(fy_px > 0) || !std::isfinite(fx_px) ||
      !std::isfinite(fy_px)) {
    return invalid("focal length must be positive and finite");
  }
  if (!principal_point_px.allFinite()) {
    return invalid("principal point must be finite");
  }
  return {};
}

bool operator==(const Intrinsic& a, const Intrinsic& b) {
  return a.model == b.model && a.width_px == b.width_px &&
         a.height_px == b.height_px && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.principal_point_px == b.principal_point_px &&
         a.distortion == b.distortion;
}

}  // namespace lowlap
