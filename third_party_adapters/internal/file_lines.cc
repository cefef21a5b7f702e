#include "third_party_adapters/internal/file_lines.h"

#include <algorithm>
#include <map>
#include <utility>

#include "third_party_adapters/internal/landmarks.h"
#include "third_party_adapters/internal/number_text.h"

namespace lowlap {
namespace {

/// By view and number in the file.
using FileSegments = std::map<ViewId, std::map<std::uint32_t, LineSegment>>;

FileSegments SegmentsOf(const std::vector<FileLine>& lines) {
  FileSegments segments;
  for (const FileLine& line : lines) {
    for (const SupportingSegment& segment : line.support) {
      LineSegment of_view;
      of_view.start_px = segment.start_px;
      of_view.end_px = segment.end_px;
      segments[segment.view].emplace(segment.number, of_view);
    }
  }
  return segments;
}

/// Adds the segments of the views that have none.
void AddMissingSegments(const FileSegments& segments, Scene* scene,
                        std::map<FeatureRef, FeatureIndex>* index_of,
                        SceneNotes* notes) {
  std::size_t num_renumbered = 0;
  for (const auto& [view, by_number] : segments) {
    scene->views[view];
    auto& of_view = scene->features[view].segments;
    if (!of_view.empty()) continue;
    for (const auto& [number, segment] : by_number) {
      const auto index = static_cast<FeatureIndex>(of_view.size());
      if (index != number) ++num_renumbered;
      (*index_of)[{view, number}] = index;
      of_view.push_back(segment);
    }
  }
  AddNote(num_renumbered,
          "segments have other numbers than in the file, which does not have "
          "all segments of their images",
          notes);
}

Status OutOfRange(const SupportingSegment& segment, std::size_t count) {
  return MakeError(ErrorCode::kInvalidScene,
                   "a line is supported by segment " +
                       std::to_string(segment.number) + " of image " +
                       std::to_string(segment.view.value()) + ", which has " +
                       std::to_string(count) + " segments");
}

}  // namespace

Status AddFileLines(const std::vector<FileLine>& lines, Scene* scene,
                    SceneNotes* notes) {
  std::map<FeatureRef, FeatureIndex> index_of;
  AddMissingSegments(SegmentsOf(lines), scene, &index_of, notes);
  std::size_t num_lonely = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    Track track;
    for (const SupportingSegment& segment : lines[n].support) {
      const auto found = index_of.find({segment.view, segment.number});
      const FeatureIndex index =
          found == index_of.end() ? segment.number : found->second;
      const std::size_t count =
          scene->features.at(segment.view).segments.size();
      if (index >= count) return OutOfRange(segment, count);
      track.push_back({segment.view, index});
    }
    std::sort(track.begin(), track.end());
    track.erase(std::unique(track.begin(), track.end()), track.end());
    if (track.size() < 2) {
      ++num_lonely;
      continue;
    }
    const auto id = static_cast<std::uint32_t>(n);
    LineLandmark& landmark = scene->line_structure[id];
    landmark.start = lines[n].start;
    landmark.end = lines[n].end;
    landmark.line = PluckerLine::FromPoints(landmark.start, landmark.end);
    landmark.observations = track;
    scene->line_tracks[id] = std::move(track);
  }
  AddNote(num_lonely, "lines that one segment supports were left out", notes);
  return {};
}

std::vector<FileLine> FileLinesOf(const Scene& scene, SceneNotes* notes) {
  std::size_t num_without_line = 0;
  for (const auto& [id, track] : scene.line_tracks) {
    if (scene.line_structure.count(id) == 0) ++num_without_line;
  }
  AddNote(num_without_line,
          "line tracks without a triangulated line were left out", notes);
  std::vector<FileLine> lines;
  for (const auto& [id, landmark] : scene.line_structure) {
    FileLine line{landmark.start, landmark.end, {}};
    for (const FeatureRef& observation : landmark.observations) {
      const LineSegment& segment =
          scene.features.at(observation.view).segments[observation.feature];
      line.support.push_back({observation.view, observation.feature,
                              segment.start_px, segment.end_px});
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string SegmentText(const Vec2& start_px, const Vec2& end_px) {
  return NumberText(start_px) + " " + NumberText(end_px);
}

Result<Scene> UndistortedScene(const Scene& scene, SceneNotes* notes) {
  Scene result = scene;
  std::size_t num_distorted = 0, num_stuck = 0;
  for (auto& [id, intrinsic] : result.intrinsics) {
    if (intrinsic.model == CameraModel::kSpherical) {
      return MakeError(ErrorCode::kUnsupported,
                       "intrinsic " + std::to_string(id.value()) +
                           " is a panorama, which has no undistorted form");
    }
    if (scene.intrinsics.at(id).HasDistortion()) ++num_distorted;
    intrinsic.model = CameraModel::kPinhole;
    intrinsic.distortion.clear();
  }
  const auto undistort = [&](ViewId view, Vec2* pixel_px) {
    const Intrinsic* raw = scene.FindIntrinsic(view);
    if (raw == nullptr || raw->model == CameraModel::kPinhole) return;
    if (const auto normalized = raw->Normalize(*pixel_px)) {
      *pixel_px =
          result.FindIntrinsic(view)->Project(normalized->homogeneous());
    } else {
      ++num_stuck;
    }
  };
  for (auto& [view, features] : result.features) {
    for (Vec2& pixel : features.points_px) undistort(view, &pixel);
    for (LineSegment& segment : features.segments) {
      undistort(view, &segment.start_px);
      undistort(view, &segment.end_px);
    }
  }
  for (auto& [id, landmark] : result.structure) {
    for (PointObservation& observation : landmark.observations) {
      undistort(observation.view, &observation.pixel_px);
    }
  }
  AddNote(num_distorted,
          "intrinsics have distortion: cameras, points and segments are those "
          "of undistorted photographs",
          notes);
  AddNote(num_stuck, "pixels cannot be undistorted and were left as they are",
          notes);
  return result;
}

}  // namespace lowlap
