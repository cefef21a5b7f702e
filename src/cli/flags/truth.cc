#include "cli/flags/truth.h"

#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/internal/camera_files.h"

namespace lowlap::cli {

Option AddTruthFlag(CLI::App* command, std::string* path) {
  return AddOption(command, "--gt", *path,
                   "True cameras to evaluate against, never used for "
                   "solving: a folder of Strecha's .camera files, or a "
                   "scene or model of any format");
}

Result<std::optional<GroundTruth>> LoadGroundTruth(const std::string& path,
                                                   const Scene& scene) {
  if (path.empty()) return std::optional<GroundTruth>();
  LOWLAP_ASSIGN_OR_RETURN(auto truth, ReadGroundTruth(path, scene));
  return std::optional<GroundTruth>(std::move(truth));
}

}  // namespace lowlap::cli
