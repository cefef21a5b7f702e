#include "lowlap/pipeline/output_folder.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <ostream>
#include <system_error>

#include "lowlap/core/atomic_file.h"
#include "lowlap/io/ply.h"
#include "lowlap/io/scene_binary.h"
#include "lowlap/io/scene_json.h"
#include "lowlap/pipeline/run_report.h"

namespace lowlap {
namespace fs = std::filesystem;

Status CheckOutputFolder(const std::string& folder) {
  if (folder.empty()) {
    return MakeError(ErrorCode::kIo, "the output folder has an empty name");
  }
  std::error_code error;
  // The folder, or the nearest one above it that exists.
  fs::path existing = fs::absolute(folder, error).lexically_normal();
  while (!fs::exists(existing, error) && existing.has_relative_path()) {
    existing = existing.parent_path();
  }
  if (!fs::is_directory(existing, error)) {
    return MakeError(
        ErrorCode::kIo,
        "cannot be made a folder: " + existing.string() + " is a file", folder);
  }
  if (::access(existing.c_str(), W_OK | X_OK) != 0) {
    return MakeError(
        ErrorCode::kIo,
        "cannot be written to: " + std::generic_category().message(errno) +
            " (" + existing.string() + ")",
        folder);
  }
  return {};
}

Status PrepareOutputFolder(const std::string& folder) {
  if (Status possible = CheckOutputFolder(folder); !possible) return possible;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    return MakeError(ErrorCode::kIo,
                     "cannot be made a folder" +
                         (error ? ": " + error.message() : std::string()),
                     folder);
  }
  return {};
}

Status WriteOutputs(Scene scene, const RunSummary& summary,
                    const std::string& folder) {
  if (!scene.root_path.empty()) {
    std::error_code error;
    const fs::path absolute = fs::absolute(scene.root_path, error);
    if (!error) scene.root_path = absolute.lexically_normal().string();
  }
  const auto path = [&](const char* name) {
    return (fs::path(folder) / name).string();
  };
  Status status = WriteSceneJson(scene, path("sfm_data.json"));
  if (status) status = WriteSceneBinary(scene, path("scene.lowlap"));
  if (status) status = WritePly(scene, path("cloud.ply"));
  if (status) {
    status =
        WriteReport(scene, MakeReport(summary, scene), path("report.html"));
  }
  if (!status) return status;
  return WriteFileAtomically(path("summary.json"),
                             [&](std::ostream& stream) -> Status {
                               stream << ToJson(summary, scene) << '\n';
                               return {};
                             });
}

Status WriteTextFiles(
    const std::vector<std::pair<std::string, std::string>>& files,
    const std::string& folder) {
  if (Status made = PrepareOutputFolder(folder); !made) return made;
  for (const auto& file : files) {
    const std::string& content = file.second;
    const Status written =
        WriteFileAtomically((fs::path(folder) / file.first).string(),
                            [&](std::ostream& stream) -> Status {
                              stream << content;
                              return {};
                            });
    if (!written) return written;
  }
  return {};
}

}  // namespace lowlap
