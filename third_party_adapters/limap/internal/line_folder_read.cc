#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/colmap/internal/scene_format.h"
#include "third_party_adapters/internal/landmarks.h"
#include "third_party_adapters/internal/number_text.h"
#include "third_party_adapters/limap/internal/folder_layout.h"
#include "third_party_adapters/limap/internal/line_folder.h"
#include "third_party_adapters/limap/internal/line_track.h"

namespace lowlap::limap {
namespace {

namespace fs = std::filesystem;

std::string PathIn(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

Status ReadModelIfThere(const std::string& folder, Scene* scene,
                        SceneNotes* notes) {
  const std::string model = PathIn(folder, kModelFolder);
  for (const SceneFormat& format : colmap::ColmapFormats()) {
    if (!format.Recognizes(model)) continue;
    LOWLAP_ASSIGN_OR_RETURN(*scene, format.read(model, notes));
    break;
  }
  return {};
}

/// Lines `id, name` after `number of images, N`.
Status ReadImageList(const std::string& folder, Scene* scene) {
  const std::string path = PathIn(folder, kImageList);
  const Result<std::string> text = ReadWholeFile(path);
  if (!text && text.error().code == ErrorCode::kNotFound) return {};
  if (!text) return tl::unexpected<Error>(text.error());
  TokenReader reader(*text, path);
  const std::string_view first = reader.RestOfLine();
  std::string_view line;
  std::size_t num_images = 0;
  while (reader.status() && reader.NextLine(&line)) {
    if (line.empty()) continue;
    const std::size_t comma = std::min(line.find(','), line.size());
    TokenReader number(line.substr(0, comma), {});
    const auto id = number.Next<std::uint32_t>("an image id");
    if (!number.status() || comma == line.size() || !number.AtEnd()) {
      reader.Fail("'id, name' is expected, not '" +
                  Escaped(std::string(line.substr(0, 32))) + "'");
      break;
    }
    View& view = scene->views[id];
    if (view.filename.empty()) {
      const std::size_t start = line.find_first_not_of(" ,", comma);
      view.filename = start == line.npos ? "" : line.substr(start);
    }
    ++num_images;
  }
  if (reader.status() &&
      first != "number of images, " + std::to_string(num_images)) {
    reader.Fail("the file has " + std::to_string(num_images) +
                " images, but its first line is '" +
                Escaped(std::string(first.substr(0, 32))) + "'");
  }
  return reader.status();
}

Result<std::vector<LineSegment>> ReadSegments(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  TokenReader reader(text, path);
  std::vector<LineSegment> segments;
  const auto count = reader.Next<std::uint32_t>("the number of segments");
  for (std::uint32_t n = 0; n < count && reader.status(); ++n) {
    LineSegment segment;
    segment.start_px = NextVec2("a coordinate of a segment", &reader);
    segment.end_px = NextVec2("a coordinate of a segment", &reader);
    segments.push_back(segment);
  }
  if (reader.status() && !reader.AtEnd()) {
    reader.Fail("more than the segments that the first line announces");
  }
  if (!reader.status()) return reader.error();
  return segments;
}

Status ReadAllSegments(const std::string& folder, Scene* scene) {
  LOWLAP_ASSIGN_OR_RETURN(
      const std::string detector,
      OnlyFolderBelow(PathIn(folder, "line_detections"), 1));
  if (detector.empty()) return {};
  for (const auto& [id, path] :
       NumberedFiles(PathIn(detector, "segments"), "segments_", ".txt")) {
    scene->views[id];
    LOWLAP_ASSIGN_OR_RETURN(scene->features[id].segments, ReadSegments(path));
  }
  return {};
}

Status ReadAllTracks(const std::string& folder, Scene* scene,
                     SceneNotes* notes) {
  const std::string track_folder = PathIn(folder, kTrackFolder);
  std::vector<FileLine> lines;
  for (const auto& [n, path] : NumberedFiles(track_folder, "track_", ".txt")) {
    if (n != lines.size()) {
      return MakeError(ErrorCode::kInvalidScene,
                       "has no track_" + std::to_string(lines.size()) + ".txt",
                       track_folder);
    }
    LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
    LOWLAP_ASSIGN_OR_RETURN(FileLine line, ParseLineTrack(text, path));
    lines.push_back(std::move(line));
  }
  Status status = AddFileLines(lines, scene, notes);
  if (!status) status.error().file = track_folder;
  return status;
}

using LineMatches = std::map<ViewPair, std::set<FeatureMatch>>;

/// Lines `neighbour, segment of the image, segment of the neighbour`.
Status ReadMatches(std::uint32_t image, const std::string& path,
                   const Scene& scene, LineMatches* matches) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  TokenReader reader(text, path);
  const auto check_segment = [&](ViewId view, FeatureIndex index) {
    const auto features = scene.features.find(view);
    if (!reader.status() || (features != scene.features.end() &&
                             index < features->second.segments.size())) {
      return;
    }
    reader.Fail("image " + std::to_string(view.value()) + " has no segment " +
                std::to_string(index));
  };
  while (reader.status() && !reader.AtEnd()) {
    const auto neighbor = reader.Next<std::uint32_t>("an image id");
    const auto own = reader.Next<std::uint32_t>("a segment");
    const auto other = reader.Next<std::uint32_t>("a segment");
    check_segment(image, own);
    check_segment(neighbor, other);
    if (reader.status() && neighbor == image) {
      reader.Fail("the image is matched with itself");
    }
    if (!reader.status()) break;
    if (image < neighbor) {
      (*matches)[{image, neighbor}].insert({own, other});
    } else {
      (*matches)[{neighbor, image}].insert({other, own});
    }
  }
  return reader.status();
}

/// The relative poses of the model, with the matches as inliers.
void AddMatches(const LineMatches& matches, Scene* scene, SceneNotes* notes) {
  std::size_t num_unposed = 0;
  for (const auto& [views, pairs] : matches) {
    const Pose* first = scene->FindPose(views.first);
    const Pose* second = scene->FindPose(views.second);
    if (!first || !second || first->center == second->center) {
      ++num_unposed;
      continue;
    }
    const RigidTransform cam2_from_cam1 =
        second->CamFromWorld() * first->CamFromWorld().Inverse();
    RelativePose& pose = scene->relative_poses[views];
    pose.views = views;
    pose.rotation = cam2_from_cam1.rotation;
    pose.direction = cam2_from_cam1.translation.normalized();
    pose.line_inliers.assign(pairs.begin(), pairs.end());
  }
  AddNote(scene->relative_poses.size(),
          "relative poses are those of the model's views, with the matches of "
          "lines as their inliers",
          notes);
  AddNote(num_unposed,
          "pairs of images have matches but no relative pose and were left out",
          notes);
}

Status ReadAllMatches(const std::string& folder, Scene* scene,
                      SceneNotes* notes) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string matcher,
                          OnlyFolderBelow(PathIn(folder, "line_matchings"), 3));
  const auto files = NumberedFiles(matcher, "matches_", ".txt");
  LineMatches matches;
  for (const auto& [image, path] : files) {
    LOWLAP_RETURN_IF_ERROR(ReadMatches(image, path, *scene, &matches));
  }
  AddMatches(matches, scene, notes);
  const auto pickled = NumberedFiles(matcher, "matches_", ".npy");
  if (files.empty()) {
    AddNote(pickled.size(),
            "files of matches are pickled and were left out; limap_text.py "
            "makes text of them",
            notes);
  }
  return {};
}

}  // namespace

Result<Scene> ReadLineFolder(const std::string& folder, SceneNotes* notes) {
  Scene scene;
  LOWLAP_RETURN_IF_ERROR(ReadModelIfThere(folder, &scene, notes));
  LOWLAP_RETURN_IF_ERROR(ReadImageList(folder, &scene));
  LOWLAP_RETURN_IF_ERROR(ReadAllSegments(folder, &scene));
  LOWLAP_RETURN_IF_ERROR(ReadAllTracks(folder, &scene, notes));
  LOWLAP_RETURN_IF_ERROR(ReadAllMatches(folder, &scene, notes));
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  return scene;
}

}  // namespace lowlap::limap
