#include "lowlap/pipeline/internal/output/output_folder.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/io/internal/ply.h"
#include "lowlap/io/internal/scene_binary.h"
#include "lowlap/pipeline/internal/output/run_report.h"
#include "lowlap/pipeline/internal/output/summary_json.h"

namespace lowlap {
namespace fs = std::filesystem;
namespace {

constexpr char kListing[] = "sfm_data.json";
constexpr char kScene[] = "scene.lowlap";
constexpr char kCloud[] = "cloud.ply";
constexpr char kReport[] = "report.html";
constexpr char kSummary[] = "summary.json";

}  // namespace

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

OutputFolder::~OutputFolder() {
  std::error_code is_in_use;
  for (const std::string& folder : made_) fs::remove(folder, is_in_use);
}

Status OutputFolder::Make(const std::string& folder) {
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(folder));
  std::error_code error;
  for (fs::path missing = fs::absolute(folder, error).lexically_normal();
       !missing.empty() && !fs::exists(missing, error);
       missing = missing.parent_path()) {
    made_.push_back(missing.string());
  }
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    return MakeError(ErrorCode::kIo,
                     "cannot be made a folder" +
                         (error ? ": " + error.message() : std::string()),
                     folder);
  }
  return {};
}

std::vector<std::string> OutputFiles(const std::string& folder) {
  std::vector<std::string> paths;
  for (const char* name : {kListing, kScene, kCloud, kReport, kSummary}) {
    paths.push_back((fs::path(folder) / name).string());
  }
  return paths;
}

Status WriteOutputs(Scene scene, const RunSummary& summary,
                    const RunContext& context, const std::string& folder,
                    const std::function<Status(const Scene&)>& before_commit) {
  if (!scene.root_path.empty()) {
    std::error_code error;
    const fs::path absolute = fs::absolute(scene.root_path, error);
    // One that is relative to elsewhere would be lost.
    if (!error && fs::is_directory(absolute, error)) {
      scene.root_path = absolute.lexically_normal().string();
    }
  }
  OutputFolder made;
  LOWLAP_RETURN_IF_ERROR(made.Make(folder));
  FileSet files;
  // One after the other, so that one content at a time is in memory.
  const auto add = [&](const char* name,
                       const Result<std::string>& content) -> Status {
    LOWLAP_RETURN_IF_ERROR(content);
    return files.Add((fs::path(folder) / name).string(), *content);
  };
  LOWLAP_RETURN_IF_ERROR(add(kListing, FormatSceneJson(scene)));
  LOWLAP_RETURN_IF_ERROR(add(kScene, FormatSceneBinary(scene)));
  LOWLAP_RETURN_IF_ERROR(add(kCloud, FormatPly(scene)));
  LOWLAP_ASSIGN_OR_RETURN(const auto report,
                          MakeReport(summary, scene, context));
  LOWLAP_RETURN_IF_ERROR(add(kReport, FormatReport(scene, report)));
  LOWLAP_RETURN_IF_ERROR(add(kSummary, ToJson(summary, scene) + "\n"));
  if (before_commit) LOWLAP_RETURN_IF_ERROR(before_commit(scene));
  return files.Commit();
}

Status WriteTextFiles(
    const std::vector<std::pair<std::string, std::string>>& files,
    const std::string& folder) {
  OutputFolder made;
  LOWLAP_RETURN_IF_ERROR(made.Make(folder));
  FileSet set;
  for (const auto& [name, content] : files) {
    LOWLAP_RETURN_IF_ERROR(
        set.Add((fs::path(folder) / name).string(), content));
  }
  return set.Commit();
}

}  // namespace lowlap
