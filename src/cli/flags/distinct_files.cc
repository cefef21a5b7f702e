#include "cli/flags/distinct_files.h"

#include <filesystem>
#include <system_error>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/run_output.h"

namespace lowlap::cli {
namespace {

namespace fs = std::filesystem;

bool IsSameFile(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  // Files that are not there yet.
  const fs::path place = fs::weakly_canonical(a, ignored);
  return !place.empty() && place == fs::weakly_canonical(b, ignored);
}

}  // namespace

Status CheckDistinct(const std::vector<NamedFile>& inputs,
                     const std::vector<NamedFile>& outputs) {
  std::vector<NamedFile> others = inputs;
  for (const NamedFile& output : outputs) {
    for (const NamedFile& other : others) {
      if (IsSameFile(output.path, other.path)) {
        return MakeError(ErrorCode::kInvalidArgument,
                         other.what + " and " + output.what + " name one file",
                         output.path);
      }
    }
    others.push_back(output);
  }
  return {};
}

Status CheckInputsStay(const std::vector<NamedFile>& inputs,
                       const std::string& output_folder,
                       const std::string& scene_file) {
  std::vector<std::string> results = OutputFiles(output_folder);
  results.push_back(scene_file);
  for (const std::string& result : results) {
    LOWLAP_RETURN_IF_ERROR(
        CheckDistinct(inputs, {{"a result of --output", result}}));
  }
  return {};
}

}  // namespace lowlap::cli
