#include <initializer_list>

#include "lowlap/io/internal/json/json_text.h"
#include "lowlap/io/internal/json/scene_json_sections.h"
#include "lowlap/io/internal/scene_version.h"

namespace lowlap {
namespace {

template <class... Ids>
void AppendIds(std::string& text, Ids... ids) {
  AppendElements(
      std::initializer_list<std::uint32_t>{static_cast<std::uint32_t>(ids)...},
      text);
}

// `{`, and the first member.
template <class Value>
void OpenRecord(std::string_view name, const Value& value, std::string& text) {
  text += "{";
  AppendMember(name, value, text);
}

void AppendTrackMember(const Track& track, std::string& text) {
  AppendKey("observations", text);
  text += "[";
  for (const FeatureRef& ref : track) AppendIds(text, ref.view, ref.feature);
  text += "]";
}

void AppendMatches(std::string_view name,
                   const std::vector<FeatureMatch>& matches,
                   std::string& text) {
  AppendKey(name, text);
  text += "[";
  for (const FeatureMatch& match : matches) {
    AppendIds(text, match.first, match.second);
  }
  text += "]";
}

void AppendFeatures(ViewId view, const ViewFeatures& features,
                    std::string& text) {
  OpenRecord("view", view, text);
  AppendKey("points", text);
  text += "[";
  for (const Vec2& point : features.points_px) AppendElements(point, text);
  text += "]";
  if (!features.point_covariances.empty()) {
    AppendKey("point_covariances", text);
    text += "[";
    for (const Vec3& shape : features.point_covariances) {
      AppendElements(shape, text);
    }
    text += "]";
  }
  AppendKey("segments", text);
  text += "[";
  for (const LineSegment& segment : features.segments) {
    AppendElements(segment.start_px, text);
    AppendElements(segment.end_px, text);
    AppendComma(text);
    AppendValue(segment.stddev_px, text);
  }
  text += "]}";
}

// Of a relative pose, or of an alternative to it.
template <class Motion>
void AppendMotion(const Motion& motion, std::string& text) {
  AppendMember("rotation", motion.rotation, text);
  AppendMember("direction", motion.direction, text);
  AppendMember("log10_nfa", motion.log10_nfa, text);
  if (motion.covariance) {
    AppendMember("covariance", *motion.covariance, text);
  }
}

void AppendRelativePose(const ViewPair& views, const RelativePose& edge,
                        std::string& text) {
  OpenRecord("views", std::vector<ViewId>{views.first, views.second}, text);
  AppendMotion(edge, text);
  AppendMember("point_threshold_px", edge.point_threshold_px, text);
  AppendMatches("point_inliers", edge.point_inliers, text);
  AppendMatches("line_inliers", edge.line_inliers, text);
  if (!edge.alternatives.empty()) {
    AppendKey("alternatives", text);
    text += "[";
    for (const AlternativeMotion& motion : edge.alternatives) {
      AppendComma(text);
      text += "{";
      AppendMotion(motion, text);
      text += "}";
    }
    text += "]";
  }
  text += "}";
}

void AppendKind(const KindSupport& support, std::string& text) {
  OpenRecord("kind", support.kind, text);
  AppendMember("candidates", support.candidates, text);
  AppendMember("inliers", support.inliers, text);
  AppendMember("log10_nfa", support.log10_nfa, text);
  AppendMember("threshold_px", support.threshold_px, text);
  AppendMember("information_share", support.information_share, text);
  AppendMember("min_agreeing", support.min_agreeing, text);
  text += "}";
}

void AppendScaleRatio(const ScaleRatio& ratio, std::string& text) {
  const auto& [first, middle, last] = ratio.views;
  OpenRecord("views", std::vector<ViewId>{first, middle, last}, text);
  AppendMember("verdict", RatioVerdictName(ratio.verdict), text);
  AppendMember("log_ratio", ratio.log_ratio, text);
  AppendMember("log_ratio_stddev", ratio.log_ratio_stddev, text);
  AppendMember("log10_nfa", ratio.log10_nfa, text);
  if (ratio.second_mode) {
    AppendKey("second_mode", text);
    text += "{";
    AppendMember("log_ratio", ratio.second_mode->log_ratio, text);
    AppendMember("log10_nfa", ratio.second_mode->log10_nfa, text);
    text += "}";
  }
  AppendKey("kinds", text);
  text += "[";
  for (const KindSupport& support : ratio.kinds) {
    AppendComma(text);
    AppendKind(support, text);
  }
  text += "]";
  AppendMember("num_rejected_negative", ratio.num_rejected_negative, text);
  AppendKey("coplanar_inliers", text);
  text += "[";
  for (const CoplanarInlier& inlier : ratio.coplanar_inliers) {
    AppendIds(text, inlier.line_in_first, inlier.line_in_last);
  }
  text += "]}";
}

void AppendGivenIntrinsic(IntrinsicId id, const Intrinsic& intrinsic,
                          std::string& text) {
  OpenRecord("id", id, text);
  AppendMember("model", CameraModelName(intrinsic.model), text);
  AppendMember("width", intrinsic.width_px, text);
  AppendMember("height", intrinsic.height_px, text);
  AppendMember("fx", intrinsic.fx_px, text);
  AppendMember("fy", intrinsic.fy_px, text);
  AppendMember("principal_point", intrinsic.principal_point_px, text);
  AppendMember("distortion", intrinsic.distortion, text);
  text += "}";
}

void AppendLine(LineTrackId id, const LineLandmark& landmark,
                std::string& text) {
  OpenRecord("id", id, text);
  AppendMember("direction", landmark.line.direction, text);
  AppendMember("moment", landmark.line.moment, text);
  AppendMember("start", landmark.start, text);
  AppendMember("end", landmark.end, text);
  AppendTrackMember(landmark.observations, text);
  text += "}";
}

}  // namespace

void AppendOwnSections(const Scene& scene, std::string& text) {
  const auto append_track = [](auto id, const Track& track, std::string& out) {
    OpenRecord("id", id, out);
    AppendTrackMember(track, out);
    out += "}";
  };
  text += "\"version\": " + std::to_string(kSceneVersion);
  AppendSection("given_intrinsics", scene.given_intrinsics,
                AppendGivenIntrinsic, text);
  AppendSection("features", scene.features, AppendFeatures, text);
  AppendSection("relative_poses", scene.relative_poses, AppendRelativePose,
                text);
  AppendSection("point_tracks", scene.point_tracks, append_track, text);
  AppendSection("line_tracks", scene.line_tracks, append_track, text);
  AppendSection("scale_ratios", scene.scale_ratios, AppendScaleRatio, text);
  AppendSection("line_structure", scene.line_structure, AppendLine, text);
  text += ",\n\"coplanar_pairs\": [";
  for (const CoplanarPair& pair : scene.coplanar_pairs) {
    AppendIds(text, pair.first, pair.second);
  }
  text += "]";
}

}  // namespace lowlap
