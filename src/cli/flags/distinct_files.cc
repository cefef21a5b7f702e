#include "cli/flags/distinct_files.h"

#include <filesystem>
#include <system_error>

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

}  // namespace lowlap::cli
