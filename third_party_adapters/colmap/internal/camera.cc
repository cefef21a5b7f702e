#include "third_party_adapters/colmap/internal/camera.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace lowlap::colmap {
namespace {

// A coefficient that only zero makes one of our models.
constexpr int kMustBeZero = -1;

struct ModelEntry {
  int id;
  const char* name;
  int focals;
  /// Ours, of which each parameter after the principal point is a coefficient.
  std::optional<CameraModel> ours;
  std::vector<int> coefficients;
};

const std::vector<ModelEntry>& Models() {
  constexpr int kZero = kMustBeZero;
  static const std::vector<ModelEntry> models = {
      {0, "SIMPLE_PINHOLE", 1, CameraModel::kPinhole, {}},
      {1, "PINHOLE", 2, CameraModel::kPinhole, {}},
      {2, "SIMPLE_RADIAL", 1, CameraModel::kRadialK1, {0}},
      {3, "RADIAL", 1, CameraModel::kRadialK3, {0, 1}},
      {4, "OPENCV", 2, CameraModel::kBrownT2, {0, 1, 3, 4}},
      {5, "OPENCV_FISHEYE", 2, CameraModel::kFisheye, {0, 1, 2, 3}},
      {6,
       "FULL_OPENCV",
       2,
       CameraModel::kBrownT2,
       {0, 1, 3, 4, 2, kZero, kZero, kZero}},
      {7, "FOV", 2, std::nullopt, {kZero}},
      {8, "SIMPLE_RADIAL_FISHEYE", 1, CameraModel::kFisheye, {0}},
      {9, "RADIAL_FISHEYE", 1, CameraModel::kFisheye, {0, 1}},
      {10,
       "THIN_PRISM_FISHEYE",
       2,
       CameraModel::kFisheye,
       {0, 1, kZero, kZero, 2, 3, kZero, kZero}},
      {11,
       "RAD_TAN_THIN_PRISM_FISHEYE",
       2,
       CameraModel::kFisheye,
       {0, 1, 2, 3, kZero, kZero, kZero, kZero, kZero, kZero, kZero, kZero}},
      {12, "SIMPLE_DIVISION", 1, CameraModel::kPinhole, {kZero}},
      {13, "DIVISION", 2, CameraModel::kPinhole, {kZero}},
      {14, "SIMPLE_FISHEYE", 1, CameraModel::kFisheye, {}},
      {15, "FISHEYE", 2, CameraModel::kFisheye, {}},
      {16, "EUCM", 2, std::nullopt, {kZero, kZero}},
      {17, "EQUIRECTANGULAR", 0, CameraModel::kSpherical, {}},
  };
  return models;
}

const ModelEntry* Find(int model) {
  const auto& models = Models();
  return model >= 0 && model < static_cast<int>(models.size()) ? &models[model]
                                                               : nullptr;
}

// COLMAP's panoramas fill the sphere, width by height.
bool IsWholeSphere(double width_px, double height_px) {
  return width_px == 2 * height_px;
}

}  // namespace

const char* ModelName(int model) {
  const ModelEntry* entry = Find(model);
  return entry == nullptr ? nullptr : entry->name;
}

std::optional<int> ModelFromName(const std::string& name) {
  for (const ModelEntry& entry : Models()) {
    if (name == entry.name) return entry.id;
  }
  return std::nullopt;
}

std::optional<std::size_t> ParameterCount(int model) {
  const ModelEntry* entry = Find(model);
  if (entry == nullptr) return std::nullopt;
  return static_cast<std::size_t>(entry->focals) + 2 +
         entry->coefficients.size();
}

Result<Intrinsic> ToIntrinsic(const Camera& camera) {
  const std::string name = "camera " + std::to_string(camera.id);
  const ModelEntry* entry = Find(camera.model);
  const auto unsupported = [&](const std::string& why) {
    return MakeError(ErrorCode::kUnsupported, name + why);
  };
  if (entry == nullptr) {
    return unsupported(" has model " + std::to_string(camera.model) +
                       ", which is not known");
  }
  const std::string of_model = name + " (" + entry->name + ")";
  const auto invalid = [&](const std::string& why) {
    return MakeError(ErrorCode::kInvalidScene, of_model + ": " + why);
  };
  if (camera.params.size() != *ParameterCount(camera.model)) {
    return invalid(std::to_string(camera.params.size()) +
                   " parameters, where there are " +
                   std::to_string(*ParameterCount(camera.model)));
  }
  constexpr std::uint64_t kMaxSide = std::numeric_limits<int>::max();
  if (camera.width_px > kMaxSide || camera.height_px > kMaxSide) {
    return invalid("the image size is out of range");
  }
  if (!entry->ours) {
    return unsupported(std::string(" has model ") + entry->name +
                       ", which no model of lowlap equals; undistort the "
                       "images first");
  }
  Intrinsic intrinsic;
  intrinsic.model = *entry->ours;
  intrinsic.width_px = static_cast<int>(camera.width_px);
  intrinsic.height_px = static_cast<int>(camera.height_px);
  intrinsic.distortion.resize(
      static_cast<std::size_t>(DistortionCount(intrinsic.model)));
  const double* params = camera.params.data();
  if (intrinsic.model == CameraModel::kSpherical) {
    if (!IsWholeSphere(intrinsic.width_px, intrinsic.height_px) ||
        params[0] != intrinsic.width_px || params[1] != intrinsic.height_px) {
      return unsupported(
          " (EQUIRECTANGULAR) is not a panorama twice as wide as high");
    }
  } else {
    intrinsic.fx_px = params[0];
    intrinsic.fy_px = params[entry->focals - 1];
    params += entry->focals;
    intrinsic.principal_point_px =
        Vec2(params[0], params[1]) - PixelShift(intrinsic);
    params += 2;
    for (std::size_t n = 0; n < entry->coefficients.size(); ++n) {
      const int place = entry->coefficients[n];
      if (place != kMustBeZero) {
        intrinsic.distortion[static_cast<std::size_t>(place)] = params[n];
      } else if (params[n] != 0) {
        return unsupported(std::string(" has model ") + entry->name +
                           ", which equals a model of lowlap only where its "
                           "distortion coefficient " +
                           std::to_string(n + 1) + " is 0");
      }
    }
  }
  if (const Status valid = intrinsic.Validate(); !valid) {
    return invalid(valid.error().message);
  }
  return intrinsic;
}

Result<Camera> FromIntrinsic(const Intrinsic& intrinsic, std::uint32_t id) {
  const std::vector<double>& k = intrinsic.distortion;
  const double fx = intrinsic.fx_px, fy = intrinsic.fy_px;
  const Vec2 pp = intrinsic.principal_point_px + PixelShift(intrinsic);
  Camera camera;
  camera.id = id;
  camera.width_px = static_cast<std::uint64_t>(intrinsic.width_px);
  camera.height_px = static_cast<std::uint64_t>(intrinsic.height_px);
  const auto set = [&](const char* name, std::vector<double> coefficients) {
    camera.model = *ModelFromName(name);
    camera.params = {fx};
    if (Find(camera.model)->focals == 2) camera.params.push_back(fy);
    camera.params.insert(camera.params.end(), {pp.x(), pp.y()});
    camera.params.insert(camera.params.end(), coefficients.begin(),
                         coefficients.end());
  };
  const bool one_focal = fx == fy;
  switch (intrinsic.model) {
    case CameraModel::kPinhole:
      set(one_focal ? "SIMPLE_PINHOLE" : "PINHOLE", {});
      break;
    case CameraModel::kRadialK1:
      if (one_focal) {
        set("SIMPLE_RADIAL", k);
      } else {
        set("OPENCV", {k[0], 0, 0, 0});
      }
      break;
    case CameraModel::kRadialK3:
      if (k[2] != 0) {
        set("FULL_OPENCV", {k[0], k[1], 0, 0, k[2], 0, 0, 0});
      } else if (one_focal) {
        set("RADIAL", {k[0], k[1]});
      } else {
        set("OPENCV", {k[0], k[1], 0, 0});
      }
      break;
    case CameraModel::kBrownT2:
      if (k[2] != 0) {
        set("FULL_OPENCV", {k[0], k[1], k[3], k[4], k[2], 0, 0, 0});
      } else {
        set("OPENCV", {k[0], k[1], k[3], k[4]});
      }
      break;
    case CameraModel::kFisheye:
      set("OPENCV_FISHEYE", k);
      break;
    case CameraModel::kSpherical:
      if (!IsWholeSphere(intrinsic.width_px, intrinsic.height_px)) {
        return MakeError(ErrorCode::kUnsupported,
                         "a panorama of " + std::to_string(intrinsic.width_px) +
                             " x " + std::to_string(intrinsic.height_px) +
                             "; COLMAP's are twice as wide as high");
      }
      camera.model = *ModelFromName("EQUIRECTANGULAR");
      camera.params = {static_cast<double>(intrinsic.width_px),
                       static_cast<double>(intrinsic.height_px)};
      break;
  }
  return camera;
}

Vec2 PixelShift(const Intrinsic& intrinsic) {
  return intrinsic.model == CameraModel::kSpherical ? Vec2(0, 0)
                                                    : Vec2(0.5, 0.5);
}

}  // namespace lowlap::colmap
