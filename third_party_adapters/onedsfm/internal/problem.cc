#include "third_party_adapters/onedsfm/internal/problem.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/bundler/internal/bundle.h"
#include "third_party_adapters/bundler/internal/image_list.h"
#include "third_party_adapters/onedsfm/internal/problem_files.h"

namespace lowlap::onedsfm {
namespace {

namespace fs = std::filesystem;

std::string PathOf(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

/// Reads what a file of the folder holds; nothing if it does not exist.
template <class T>
Status ReadIfThere(const std::string& path,
                   Result<T> (*parse)(std::string_view, const std::string&),
                   std::optional<T>* content) {
  const Result<std::string> text = ReadWholeFile(path);
  if (!text && text.error().code == ErrorCode::kNotFound) return {};
  if (!text) return tl::unexpected<Error>(text.error());
  LOWLAP_ASSIGN_OR_RETURN(*content, parse(*text, path));
  return {};
}

/// The files of a folder.
struct Files {
  std::optional<std::vector<RelativeGeometry>> geometries;
  std::optional<std::vector<ImageIndex>> used;
  std::optional<std::vector<bundler::ListedImage>> list;
  std::optional<std::map<ImageIndex, ImageKeys>> coords;
  std::optional<std::vector<KeyTrack>> tracks;
};

Result<Files> ReadFiles(const std::string& folder) {
  Files files;
  const auto read = [&](const char* name, auto parse, auto* content) {
    return ReadIfThere(PathOf(folder, name), parse, content);
  };
  LOWLAP_RETURN_IF_ERROR(read("EGs.txt", ParseGeometries, &files.geometries));
  if (!files.geometries) {
    return MakeError(ErrorCode::kNotFound, "there is no EGs.txt", folder);
  }
  LOWLAP_RETURN_IF_ERROR(read("cc.txt", ParseIndices, &files.used));
  LOWLAP_RETURN_IF_ERROR(read("list.txt", bundler::ParseList, &files.list));
  LOWLAP_RETURN_IF_ERROR(read("coords.txt", ParseCoords, &files.coords));
  LOWLAP_RETURN_IF_ERROR(read("tracks.txt", ParseTracks, &files.tracks));
  return files;
}

std::set<ImageIndex> UsedImages(const Files& files) {
  if (files.used) return {files.used->begin(), files.used->end()};
  std::set<ImageIndex> used;
  for (const RelativeGeometry& geometry : *files.geometries) {
    used.insert(geometry.i);
    used.insert(geometry.j);
  }
  return used;
}

Status CheckListed(const std::vector<bundler::ListedImage>& list,
                   ImageIndex index, const std::string& folder) {
  if (index < list.size()) return {};
  return MakeError(ErrorCode::kInvalidScene,
                   "has " + std::to_string(list.size()) + " images; image " +
                       std::to_string(index) + " is used",
                   PathOf(folder, "list.txt"));
}

void SetPath(const fs::path& path, View* view) {
  view->local_path = path.parent_path().generic_string();
  view->filename = path.filename().string();
}

Status AddView(const Files& files, const std::string& folder, ImageIndex index,
               Scene* scene) {
  std::string path = std::to_string(index);
  double focal_px = 0;
  if (files.list) {
    LOWLAP_RETURN_IF_ERROR(CheckListed(*files.list, index, folder));
    path = (*files.list)[index].name;
    focal_px = (*files.list)[index].focal_px;
  }
  View view;
  if (files.coords) {
    const auto found = files.coords->find(index);
    if (found == files.coords->end()) {
      return MakeError(
          ErrorCode::kInvalidScene,
          "has no image " + std::to_string(index) + ", which is used",
          PathOf(folder, "coords.txt"));
    }
    const ImageKeys& keys = found->second;
    if (!files.list && !keys.name.empty()) path = keys.name;
    if (keys.focal_px > 0) focal_px = keys.focal_px;
    view.width_px = static_cast<int>(std::lround(2 * keys.half_size_px.x()));
    view.height_px = static_cast<int>(std::lround(2 * keys.half_size_px.y()));
    ViewFeatures& features = scene->features[index];
    for (const Vec2& key : keys.keys_px) {
      features.points_px.emplace_back(key - Vec2::Ones());
    }
  }
  SetPath(path, &view);
  view.pose_id = index;
  if (focal_px > 0 && view.width_px > 0 && view.height_px > 0) {
    Intrinsic intrinsic;
    intrinsic.width_px = view.width_px;
    intrinsic.height_px = view.height_px;
    intrinsic.fx_px = intrinsic.fy_px = focal_px;
    intrinsic.principal_point_px = {(view.width_px - 1) / 2.0,
                                    (view.height_px - 1) / 2.0};
    scene->intrinsics[index] = intrinsic;
    view.intrinsic_id = index;
  }
  scene->views[index] = view;
  return {};
}

void AddNote(std::size_t count, const std::string& what, Problem* problem) {
  if (count > 0) {
    problem->notes.push_back(std::to_string(count) + " " + what);
  }
}

void AddRelativePoses(const Files& files, Problem* problem) {
  Scene& scene = problem->scene;
  const Vec3 axes(1, -1, -1);
  std::size_t num_unused = 0, num_repeated = 0;
  for (const RelativeGeometry& geometry : *files.geometries) {
    if (scene.views.count(geometry.i) == 0 ||
        scene.views.count(geometry.j) == 0) {
      ++num_unused;
      continue;
    }
    // x_i = R_ij x_j + s t_ij, in our axes.
    const Mat3 i_from_j =
        axes.asDiagonal() * geometry.rotation * axes.asDiagonal();
    const Vec3 direction = axes.asDiagonal() * geometry.direction;
    RelativePose pose;
    if (geometry.i < geometry.j) {
      pose.views = {geometry.i, geometry.j};
      pose.rotation = i_from_j.transpose();
      pose.direction = -(pose.rotation * direction);
    } else {
      pose.views = {geometry.j, geometry.i};
      pose.rotation = i_from_j;
      pose.direction = direction;
    }
    if (!scene.relative_poses.emplace(pose.views, pose).second) ++num_repeated;
  }
  AddNote(num_unused,
          "relative poses of images that are not used were left out", problem);
  AddNote(num_repeated, "relative poses were listed again; the first counts",
          problem);
}

/// What a track, sorted by view, matches in the pairs that have a relative
/// pose. These are far fewer than all pairs of a long track.
void AddMatches(const Track& track, Scene* scene) {
  const auto is_before = [](const auto& observation, ViewId view) {
    return observation.view < view;
  };
  for (const auto& [view, feature] : track) {
    for (auto pose = scene->relative_poses.lower_bound({view, ViewId(0)});
         pose != scene->relative_poses.end() && pose->first.first == view;
         ++pose) {
      const ViewId second = pose->first.second;
      const auto other =
          std::lower_bound(track.begin(), track.end(), second, is_before);
      if (other == track.end() || other->view != second) continue;
      pose->second.point_inliers.push_back({feature, other->feature});
    }
  }
}

Status AddTracks(const std::vector<KeyTrack>& tracks, const std::string& folder,
                 Problem* problem) {
  Scene& scene = problem->scene;
  std::size_t num_ambiguous = 0;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    std::map<ViewId, std::set<FeatureIndex>> keys_of_view;
    for (const auto& [image, key] : tracks[t]) {
      const auto features = scene.features.find(image);
      if (features == scene.features.end()) continue;
      if (key >= features->second.points_px.size()) {
        return MakeError(
            ErrorCode::kInvalidScene,
            "image " + std::to_string(image) + " has no keypoint " +
                std::to_string(key) + ", but " +
                std::to_string(features->second.points_px.size()),
            PathOf(folder, "tracks.txt"), "track " + std::to_string(t));
      }
      keys_of_view[image].insert(key);
    }
    Track track;
    for (const auto& [view, keys] : keys_of_view) {
      if (keys.size() > 1) {
        ++num_ambiguous;
        continue;
      }
      track.push_back({view, *keys.begin()});
    }
    if (track.size() < 2) continue;
    AddMatches(track, &scene);
    scene.point_tracks[static_cast<PointTrackId>(t)] = std::move(track);
  }
  for (auto& [views, pose] : scene.relative_poses) {
    std::sort(pose.point_inliers.begin(), pose.point_inliers.end());
    pose.point_inliers.erase(
        std::unique(pose.point_inliers.begin(), pose.point_inliers.end()),
        pose.point_inliers.end());
  }
  AddNote(num_ambiguous,
          "times a track sees one image twice; it was left out there", problem);
  return {};
}

}  // namespace

bool IsProblemFolder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) &&
         fs::exists(fs::path(path) / "EGs.txt", ignored);
}

Result<Problem> ReadProblem(const std::string& folder) {
  LOWLAP_ASSIGN_OR_RETURN(const Files files, ReadFiles(folder));
  Problem problem;
  for (const ImageIndex index : UsedImages(files)) {
    LOWLAP_RETURN_IF_ERROR(AddView(files, folder, index, &problem.scene));
  }
  AddRelativePoses(files, &problem);
  if (files.tracks && !files.coords) {
    AddNote(files.tracks->size(), "tracks mean nothing without coords.txt",
            &problem);
  } else if (files.tracks) {
    LOWLAP_RETURN_IF_ERROR(AddTracks(*files.tracks, folder, &problem));
  }
  AddNote(problem.scene.views.size() - problem.scene.intrinsics.size(),
          "views have no known focal length", &problem);
  LOWLAP_RETURN_IF_ERROR(ValidateScene(problem.scene));
  return problem;
}

Result<Scene> ReadTrueCameras(const std::string& folder) {
  std::optional<std::map<ViewId, Pose>> poses;
  std::optional<std::vector<bundler::ListedImage>> list;
  LOWLAP_RETURN_IF_ERROR(ReadIfThere(PathOf(folder, "gt_bundle.out"),
                                     bundler::ParseBundlePoses, &poses));
  if (!poses) {
    return MakeError(ErrorCode::kNotFound,
                     "there is no gt_bundle.out, the reference cameras",
                     folder);
  }
  LOWLAP_RETURN_IF_ERROR(
      ReadIfThere(PathOf(folder, "list.txt"), bundler::ParseList, &list));
  Scene scene;
  for (const auto& [index, pose] : *poses) {
    View& view = scene.views[index];
    view.pose_id = index.value();
    scene.poses[view.pose_id] = pose;
    if (!list) continue;
    LOWLAP_RETURN_IF_ERROR(CheckListed(*list, index.value(), folder));
    SetPath((*list)[index.value()].name, &view);
  }
  return scene;
}

}  // namespace lowlap::onedsfm
