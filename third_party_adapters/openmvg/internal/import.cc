#include "third_party_adapters/openmvg/internal/import.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/openmvg/internal/feat.h"
#include "third_party_adapters/openmvg/internal/scene_format.h"

namespace lowlap::openmvg {
namespace {

namespace fs = std::filesystem;

bool IsFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

Result<std::string> FindMatchFile(const std::string& given,
                                  const std::string& dir) {
  if (!given.empty()) {
    const fs::path inside = fs::path(dir) / given;
    if (IsFile(inside)) return inside.string();
    if (IsFile(given)) return given;
    return MakeError(ErrorCode::kNotFound, "no such match file", given);
  }
  for (const char* name :
       {"matches.f.txt", "matches.f.bin", "matches.e.txt", "matches.e.bin",
        "matches.putative.txt", "matches.putative.bin"}) {
    const fs::path path = fs::path(dir) / name;
    if (IsFile(path)) return path.string();
  }
  return MakeError(ErrorCode::kNotFound,
                   "the folder has no match file (matches.f, matches.e or "
                   "matches.putative, each .txt or .bin)",
                   dir);
}

Status ReadFeatures(const std::string& dir, Scene& scene) {
  std::map<std::string, ViewId> view_by_name;
  for (const auto& [id, view] : scene.views) {
    const std::string name = fs::path(view.filename).stem().string();
    const auto [entry, is_new] = view_by_name.emplace(name, id);
    const std::string path = (fs::path(dir) / (name + ".feat")).string();
    if (!is_new) {
      return MakeError(ErrorCode::kInvalidScene,
                       "views " + std::to_string(entry->second.value()) +
                           " and " + std::to_string(id.value()) +
                           " share one feature file",
                       path);
    }
    LOWLAP_ASSIGN_OR_RETURN(scene.features[id].points_px, ReadFeat(path));
  }
  return {};
}

/// The form is the one that the extension names, as in OpenMVG.
Result<Scene> ReadListing(const std::string& path) {
  for (const SceneFormats& formats : {OwnSceneFormats(), OpenMvgFormats()}) {
    for (const SceneFormat& format : formats) {
      SceneNotes ignored;
      if (format.read && format.name != "lowlap" && format.Recognizes(path)) {
        return format.read(path, &ignored);
      }
    }
  }
  return MakeError(ErrorCode::kUnsupported,
                   "an sfm_data file ends in .json, .bin or .xml", path);
}

/// Drops pairs of unknown views and checks the indices of the others.
Status CheckMatches(ImportedProject& project) {
  const Scene& scene = project.scene;
  for (auto entry = project.matches.begin(); entry != project.matches.end();) {
    const auto& [pair, matches] = *entry;
    const auto first = scene.features.find(pair.first);
    const auto second = scene.features.find(pair.second);
    if (first == scene.features.end() || second == scene.features.end()) {
      entry = project.matches.erase(entry);
      ++project.num_dropped_pairs;
      continue;
    }
    const std::size_t first_count = first->second.points_px.size();
    const std::size_t second_count = second->second.points_px.size();
    for (std::size_t n = 0; n < matches.size(); ++n) {
      const bool first_bad = matches[n].first >= first_count;
      if (!first_bad && matches[n].second < second_count) continue;
      return MakeError(
          ErrorCode::kInvalidScene,
          "feature " +
              std::to_string(first_bad ? matches[n].first : matches[n].second) +
              " does not exist: view " +
              std::to_string((first_bad ? pair.first : pair.second).value()) +
              " has " + std::to_string(first_bad ? first_count : second_count) +
              " features",
          project.match_file,
          "pair (" + std::to_string(pair.first.value()) + ", " +
              std::to_string(pair.second.value()) + "), match " +
              std::to_string(n));
    }
    ++entry;
  }
  return {};
}

}  // namespace

Result<ImportedProject> ImportProject(const std::string& sfm_data_path,
                                      const std::string& matches_dir,
                                      const ImportOptions& options) {
  LOWLAP_ASSIGN_OR_RETURN(Scene listing, ReadListing(sfm_data_path));
  ImportedProject project;
  project.scene.root_path = std::move(listing.root_path);
  project.scene.views = std::move(listing.views);
  project.scene.intrinsics = std::move(listing.intrinsics);

  // The match file first: a wrong name is found before the slow part.
  LOWLAP_ASSIGN_OR_RETURN(project.match_file,
                          FindMatchFile(options.match_file, matches_dir));
  LOWLAP_ASSIGN_OR_RETURN(project.matches, ReadMatches(project.match_file));

  LOWLAP_RETURN_IF_ERROR(ReadFeatures(matches_dir, project.scene));
  LOWLAP_RETURN_IF_ERROR(CheckMatches(project));
  // The structure of the listing names lines of the .feat files.
  if (Status valid = ValidateScene(project.scene); !valid) {
    valid.error().file = sfm_data_path;
    return tl::unexpected<Error>(valid.error());
  }
  return project;
}

}  // namespace lowlap::openmvg
