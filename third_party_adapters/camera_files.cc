#include "third_party_adapters/internal/camera_files.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/onedsfm/internal/problem.h"
#include "third_party_adapters/scene_formats.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

Result<GroundTruth> ReadTruth(const std::string& path, const Scene& scene) {
  if (onedsfm::IsProblemFolder(path)) {
    // As a scene it is what was measured.
    LOWLAP_ASSIGN_OR_RETURN(const Scene solved, onedsfm::ReadTrueCameras(path));
    return GroundTruthFromScene(solved, scene);
  }
  std::error_code ignored;
  if (!IsScene(path) && std::filesystem::is_directory(path, ignored)) {
    LOWLAP_ASSIGN_OR_RETURN(const auto poses, strecha::ReadGroundTruth(path));
    return GroundTruthByName(scene, poses);
  }
  LOWLAP_ASSIGN_OR_RETURN(const Scene solved, ReadScene(path));
  return GroundTruthFromScene(solved, scene);
}

}  // namespace

Result<IntrinsicSource> ReadIntrinsicSource(const std::string& path) {
  IntrinsicSource source;
  if (IsScene(path)) {
    LOWLAP_ASSIGN_OR_RETURN(source.scene, ReadScene(path));
  } else {
    LOWLAP_ASSIGN_OR_RETURN(source.calibration,
                            strecha::ReadCalibrationMatrix(path));
  }
  return source;
}

Result<GroundTruth> ReadGroundTruth(const std::string& path,
                                    const Scene& scene) {
  auto truth = ReadTruth(path, scene);
  if (!truth) {
    if (truth.error().file.empty()) truth.error().file = path;
    return truth;
  }
  for (const auto& entry : *truth) {
    if (scene.views.count(entry.first) > 0) return truth;
  }
  // A truth that says nothing about the scene is a mistake of the caller.
  return MakeError(
      ErrorCode::kInsufficientData,
      truth->empty()
          ? "holds no camera poses to compare with"
          : "no view of the scene has the name or the id of a true camera",
      path);
}

}  // namespace lowlap
