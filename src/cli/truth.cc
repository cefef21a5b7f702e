#include "cli/truth.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/onedsfm/internal/problem.h"
#include "third_party_adapters/scene_formats.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap::cli {
namespace {

// A truth that says nothing about the scene is a mistake in the command.
Result<std::optional<GroundTruth>> KnownTruth(GroundTruth truth,
                                              const Scene& scene,
                                              const std::string& path) {
  for (const auto& entry : truth) {
    if (scene.views.count(entry.first) > 0) {
      return std::optional<GroundTruth>(std::move(truth));
    }
  }
  return MakeError(
      ErrorCode::kInsufficientData,
      truth.empty()
          ? "holds no camera poses to compare with"
          : "no view of the scene has the name or the id of a true camera",
      path);
}

}  // namespace

Option AddTruthFlag(CLI::App* command, std::string* path) {
  return AddOption(command, "--gt", *path,
                   "True cameras to evaluate against, never used for "
                   "solving: a folder of Strecha's .camera files, or a "
                   "scene file");
}

Result<std::optional<GroundTruth>> LoadGroundTruth(const std::string& path,
                                                   const Scene& scene) {
  if (path.empty()) return std::optional<GroundTruth>();
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) {
    LOWLAP_ASSIGN_OR_RETURN(const auto solved, ReadScene(path));
    auto truth = GroundTruthFromScene(solved, scene);
    if (!truth) {
      truth.error().file = path;
      return tl::unexpected<Error>(truth.error());
    }
    return KnownTruth(std::move(*truth), scene, path);
  }
  if (onedsfm::IsProblemFolder(path)) {
    LOWLAP_ASSIGN_OR_RETURN(auto truth, onedsfm::ReadTruePoses(path));
    return KnownTruth(std::move(truth), scene, path);
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto poses, strecha::ReadGroundTruth(path));
  auto truth = GroundTruthByName(scene, poses);
  if (!truth) {
    if (truth.error().file.empty()) truth.error().file = path;
    return tl::unexpected<Error>(truth.error());
  }
  return std::optional<GroundTruth>(std::move(*truth));
}

}  // namespace lowlap::cli
