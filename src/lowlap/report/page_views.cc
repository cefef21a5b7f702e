#include <algorithm>
#include <array>
#include <cmath>

#include "lowlap/report/internal/base64.h"
#include "lowlap/report/internal/page_parts.h"
#include "lowlap/scene/internal/center_stddev.h"

namespace lowlap {
namespace {

// Of width or height, as 16 bits: 0 to 65535 over [0, size].
std::uint16_t Share(double position_px, int size_px) {
  const double share = position_px / std::max(1, size_px);
  return static_cast<std::uint16_t>(
      std::lround(65535 * (share > 0 ? std::min(share, 1.0) : 0.0)));
}

void Append(const Vec2& position_px, const View& view,
            std::vector<std::uint16_t>* shares) {
  shares->push_back(Share(position_px.x(), view.width_px));
  shares->push_back(Share(position_px.y(), view.height_px));
}

void Append(const LineSegment& segment, const View& view,
            std::vector<std::uint16_t>* shares) {
  Append(segment.start_px, view, shares);
  Append(segment.end_px, view, shares);
}

// By view and kept feature: the landmark that it observes.
using LandmarksOfFeatures = std::map<ViewId, std::vector<std::uint32_t>>;

template <class Key>
std::uint32_t PlaceOf(const std::map<Key, std::uint32_t>& shown, Key id) {
  const auto found = shown.find(id);
  return found == shown.end() ? kHiddenLandmark : found->second;
}

LandmarksOfFeatures LandmarksOfPoints(const Scene& scene,
                                      const PageIndex& index) {
  LandmarksOfFeatures landmarks;
  for (const auto& [view, places] : index.features) {
    const auto dropped = std::count(places.begin(), places.end(), kNoLandmark);
    landmarks[view].assign(places.size() - static_cast<std::size_t>(dropped),
                           kNoLandmark);
  }
  for (const auto& [id, landmark] : scene.structure) {
    for (const PointObservation& seen : landmark.observations) {
      const auto places = index.features.find(seen.view);
      if (places == index.features.end() ||
          seen.feature >= places->second.size()) {
        continue;
      }
      const std::uint32_t place = places->second[seen.feature];
      if (place != kNoLandmark) {
        landmarks[seen.view][place] = PlaceOf(index.points, id);
      }
    }
  }
  return landmarks;
}

LandmarksOfFeatures LandmarksOfSegments(const Scene& scene,
                                        const PageIndex& index) {
  LandmarksOfFeatures landmarks;
  for (const auto& [view, features] : scene.features) {
    landmarks[view].assign(features.segments.size(), kNoLandmark);
  }
  for (const auto& [id, line] : scene.line_structure) {
    for (const FeatureRef& seen : line.observations) {
      const auto found = landmarks.find(seen.view);
      if (found != landmarks.end() && seen.feature < found->second.size()) {
        found->second[seen.feature] = PlaceOf(index.lines, id);
      }
    }
  }
  return landmarks;
}

PageJson MatchedFeatures(const View& view, const ViewFeatures& features,
                         const std::vector<std::uint32_t>& places,
                         const std::vector<std::uint32_t>& points,
                         const std::vector<std::uint32_t>& lines) {
  std::vector<std::uint16_t> points_at, segments_at;
  for (std::size_t n = 0; n < features.points_px.size(); ++n) {
    if (places[n] != kNoLandmark) {
      Append(features.points_px[n], view, &points_at);
    }
  }
  for (const LineSegment& segment : features.segments) {
    Append(segment, view, &segments_at);
  }
  return {{"points", Base64(points_at)},
          {"landmarks", Base64(points)},
          {"segments", Base64(segments_at)},
          {"lines", Base64(lines)}};
}

// Evenly chosen where there are many.
PageJson DetectedFeatures(const View& view, const ViewFeatures& features,
                          std::size_t most) {
  const std::size_t count =
      features.points_px.size() + features.segments.size();
  const std::size_t limit = std::max<std::size_t>(1, most);
  const std::size_t stride =
      std::max<std::size_t>(1, (count + limit - 1) / limit);
  std::vector<std::uint16_t> points_at, segments_at;
  for (std::size_t n = 0; n < features.points_px.size(); n += stride) {
    Append(features.points_px[n], view, &points_at);
  }
  for (std::size_t n = 0; n < features.segments.size(); n += stride) {
    Append(features.segments[n], view, &segments_at);
  }
  return {{"num_points", features.points_px.size()},
          {"num_segments", features.segments.size()},
          {"points", Base64(points_at)},
          {"segments", Base64(segments_at)}};
}

// Centre, and the corners of the image plane at unit depth minus the centre:
// what a camera looks like, in the frame of the page.
PageJson CameraJson(const Pose& pose, const View& view,
                    const Intrinsic* intrinsic, const DisplayFrame& frame) {
  const Vec3 center = frame(pose.center);
  PageJson json = {{"center", {center.x(), center.y(), center.z()}}};
  const bool is_flat =
      intrinsic != nullptr && intrinsic->model != CameraModel::kSpherical;
  const double focal_px =
      is_flat ? intrinsic->MeanFocalPx()
              : std::max(1.0, 0.8 * std::max(view.width_px, view.height_px));
  const Vec2 principal_px =
      is_flat ? intrinsic->principal_point_px
              : Vec2(0.5 * view.width_px, 0.5 * view.height_px);
  PageJson& corners = json["corners"] = PageJson::array();
  for (const auto& [x, y] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    const Vec3 corner_in_cam((x * view.width_px - principal_px.x()) / focal_px,
                             (y * view.height_px - principal_px.y()) / focal_px,
                             1);
    const Vec3 corner =
        frame.rotation * (pose.rotation.transpose() * corner_in_cam);
    for (int axis = 0; axis < 3; ++axis) corners.push_back(corner(axis));
  }
  return json;
}

}  // namespace

PageJson ViewsJson(const Scene& scene, const ReportContent& content,
                   const std::optional<ReportStage>& before,
                   const PageIndex& index, const DisplayFrame& frame,
                   const PageLimits& limits) {
  const LandmarksOfFeatures points = LandmarksOfPoints(scene, index);
  const LandmarksOfFeatures lines = LandmarksOfSegments(scene, index);
  PageJson views = PageJson::array();
  for (const auto& [id, view] : scene.views) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(id);
    PageJson json = {{"id", id},
                     {"name", scene.NameOf(id)},
                     {"width", view.width_px},
                     {"height", view.height_px}};
    if (intrinsic != nullptr) {
      json["model"] = CameraModelName(intrinsic->model);
      json["focal_px"] = {intrinsic->fx_px, intrinsic->fy_px};
    }
    if (const auto jpeg = content.photographs.find(id);
        jpeg != content.photographs.end()) {
      json["photograph"] = "data:image/jpeg;base64," + Base64(jpeg->second);
    }
    if (const auto features = scene.features.find(id);
        features != scene.features.end()) {
      json["features"] =
          MatchedFeatures(view, features->second, index.features.at(id),
                          points.at(id), lines.at(id));
    }
    if (const auto detected = content.detected.find(id);
        detected != content.detected.end()) {
      json["detected"] = DetectedFeatures(view, detected->second,
                                          limits.detected / scene.views.size());
    }
    if (const Pose* pose = scene.FindPose(id)) {
      json["camera"] = CameraJson(*pose, view, intrinsic, frame);
      if (const auto stddev = CenterStddev(*pose)) {
        json["center_stddev"] = frame.scale * *stddev;
      }
    }
    if (before) {
      const auto pose = before->poses.find(view.pose_id);
      if (pose != before->poses.end()) {
        json["camera_before"] =
            CameraJson(pose->second, view, intrinsic, frame);
      }
    }
    if (content.truth) {
      const ReportTruth& truth = *content.truth;
      if (const auto pose = truth.poses.find(id); pose != truth.poses.end()) {
        json["camera_true"] = CameraJson(pose->second, view, intrinsic, frame);
      }
      if (const auto error = truth.position_errors.find(id);
          error != truth.position_errors.end()) {
        json["position_error"] = error->second;
      }
      if (const auto error = truth.rotation_errors_deg.find(id);
          error != truth.rotation_errors_deg.end()) {
        json["rotation_error_deg"] = error->second;
      }
    }
    views.push_back(std::move(json));
  }
  return views;
}

}  // namespace lowlap
