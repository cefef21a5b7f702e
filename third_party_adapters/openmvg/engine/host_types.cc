#include "third_party_adapters/openmvg/engine/host_types.h"

#include <array>
#include <charconv>
#include <filesystem>

namespace lowlap::openmvg {

Result<Intrinsic> IntrinsicFromHost(int model, int width_px, int height_px,
                                    const std::vector<double>& parameters) {
  Intrinsic intrinsic;
  intrinsic.width_px = width_px;
  intrinsic.height_px = height_px;
  switch (model) {
    case 1:
      intrinsic.model = CameraModel::kPinhole;
      break;
    case 2:
      intrinsic.model = CameraModel::kRadialK1;
      break;
    case 3:
      intrinsic.model = CameraModel::kRadialK3;
      break;
    case 4:
      intrinsic.model = CameraModel::kBrownT2;
      break;
    case 5:
      intrinsic.model = CameraModel::kFisheye;
      break;
    case 7:
      intrinsic.model = CameraModel::kSpherical;
      return intrinsic;
    default:
      return MakeError(ErrorCode::kUnsupported,
                       "lowlap knows no camera model " + std::to_string(model));
  }
  const auto expected =
      3 + static_cast<std::size_t>(DistortionCount(intrinsic.model));
  if (parameters.size() != expected) {
    return MakeError(ErrorCode::kInvalidScene,
                     std::string(CameraModelName(intrinsic.model)) + " has " +
                         std::to_string(expected) + " parameters, not " +
                         std::to_string(parameters.size()));
  }
  intrinsic.fx_px = intrinsic.fy_px = parameters[0];
  intrinsic.principal_point_px = Vec2(parameters[1], parameters[2]);
  intrinsic.distortion.assign(parameters.begin() + 3, parameters.end());
  return intrinsic;
}

View ViewFromHost(const std::string& path, std::uint32_t intrinsic,
                  std::uint32_t pose, std::uint32_t width_px,
                  std::uint32_t height_px) {
  const std::filesystem::path image(path);
  View view;
  view.local_path = image.parent_path().string();
  view.filename = image.filename().string();
  view.width_px = static_cast<int>(width_px);
  view.height_px = static_cast<int>(height_px);
  view.intrinsic_id = intrinsic;
  view.pose_id = pose;
  return view;
}

double PositionFromHost(float number) {
  // "-1.23456789e-38" is the longest.
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  double position = 0;
  std::from_chars(text.data(), end, position);
  return position;
}

void AddMatches(std::uint32_t first, std::uint32_t second,
                std::vector<FeatureMatch> matches,
                TranslationStepInput* input) {
  if (input->scene.views.count(first) == 0 ||
      input->scene.views.count(second) == 0) {
    return;
  }
  if (first > second) {
    std::swap(first, second);
    for (FeatureMatch& match : matches) std::swap(match.first, match.second);
  }
  input->matches[{first, second}] = std::move(matches);
}

}  // namespace lowlap::openmvg
