#include "lowlap/io/internal/json/json_text.h"
#include "lowlap/io/internal/json/scene_json_sections.h"

namespace lowlap {
namespace {

template <class... Ids>
void AppendIds(std::string& text, Ids... ids) {
  for (const std::uint32_t id : {static_cast<std::uint32_t>(ids)...}) {
    AppendComma(text);
    AppendInteger(id, text);
  }
}

void AppendCount(std::string_view name, int count, std::string& text) {
  AppendKey(name, text);
  AppendInteger(static_cast<std::uint32_t>(count), text);
}

void AppendNamedReal(std::string_view name, double value, std::string& text) {
  AppendKey(name, text);
  AppendReal(value, text);
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
  const auto append_numbers = [&](const auto& vector) {
    for (const double number : vector) {
      AppendComma(text);
      AppendReal(number, text);
    }
  };
  text += "{";
  AppendKey("view", text);
  AppendInteger(view.value(), text);
  AppendKey("points", text);
  text += "[";
  for (const Vec2& point : features.points_px) append_numbers(point);
  text += "]";
  if (!features.point_covariances.empty()) {
    AppendKey("point_covariances", text);
    text += "[";
    for (const Vec3& shape : features.point_covariances) append_numbers(shape);
    text += "]";
  }
  AppendKey("segments", text);
  text += "[";
  for (const LineSegment& segment : features.segments) {
    append_numbers(segment.start_px);
    append_numbers(segment.end_px);
    AppendComma(text);
    AppendReal(segment.stddev_px, text);
  }
  text += "]}";
}

// Of a relative pose, or of an alternative to it.
template <class Motion>
void AppendMotion(const Motion& motion, std::string& text) {
  AppendKey("rotation", text);
  AppendMatrix(motion.rotation, text);
  AppendKey("direction", text);
  AppendVector(motion.direction, text);
  AppendNamedReal("log10_nfa", motion.log10_nfa, text);
  if (motion.covariance) {
    AppendKey("covariance", text);
    AppendMatrix(*motion.covariance, text);
  }
}

void AppendRelativePose(const RelativePose& edge, std::string& text) {
  text += "{";
  AppendKey("views", text);
  text += "[";
  AppendIds(text, edge.views.first, edge.views.second);
  text += "]";
  AppendMotion(edge, text);
  AppendNamedReal("point_threshold_px", edge.point_threshold_px, text);
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

void AppendTrack(std::uint32_t id, const Track& track, std::string& text) {
  text += "{";
  AppendKey("id", text);
  AppendInteger(id, text);
  AppendTrackMember(track, text);
  text += "}";
}

void AppendKind(const KindSupport& support, std::string& text) {
  text += "{";
  AppendKey("kind", text);
  AppendString(support.kind, text);
  AppendCount("candidates", support.candidates, text);
  AppendCount("inliers", support.inliers, text);
  AppendNamedReal("log10_nfa", support.log10_nfa, text);
  AppendNamedReal("threshold_px", support.threshold_px, text);
  AppendNamedReal("information_share", support.information_share, text);
  AppendCount("min_agreeing", support.min_agreeing, text);
  text += "}";
}

void AppendScaleRatio(const ScaleRatio& ratio, std::string& text) {
  text += "{";
  AppendKey("views", text);
  text += "[";
  AppendIds(text, ratio.views.first, ratio.views.middle, ratio.views.last);
  text += "]";
  AppendKey("verdict", text);
  AppendString(RatioVerdictName(ratio.verdict), text);
  AppendNamedReal("log_ratio", ratio.log_ratio, text);
  AppendNamedReal("log_ratio_stddev", ratio.log_ratio_stddev, text);
  AppendNamedReal("log10_nfa", ratio.log10_nfa, text);
  if (ratio.second_mode) {
    AppendKey("second_mode", text);
    text += "{";
    AppendNamedReal("log_ratio", ratio.second_mode->log_ratio, text);
    AppendNamedReal("log10_nfa", ratio.second_mode->log10_nfa, text);
    text += "}";
  }
  AppendKey("kinds", text);
  text += "[";
  for (const KindSupport& support : ratio.kinds) {
    AppendComma(text);
    AppendKind(support, text);
  }
  text += "]";
  AppendCount("num_rejected_negative", ratio.num_rejected_negative, text);
  AppendKey("coplanar_inliers", text);
  text += "[";
  for (const CoplanarInlier& inlier : ratio.coplanar_inliers) {
    AppendIds(text, inlier.line_in_first, inlier.line_in_last);
  }
  text += "]}";
}

void AppendGivenIntrinsic(IntrinsicId id, const Intrinsic& intrinsic,
                          std::string& text) {
  text += "{";
  AppendKey("id", text);
  AppendInteger(id.value(), text);
  AppendKey("model", text);
  AppendString(CameraModelName(intrinsic.model), text);
  AppendCount("width", intrinsic.width_px, text);
  AppendCount("height", intrinsic.height_px, text);
  AppendNamedReal("fx", intrinsic.fx_px, text);
  AppendNamedReal("fy", intrinsic.fy_px, text);
  AppendKey("principal_point", text);
  AppendVector(intrinsic.principal_point_px, text);
  AppendKey("distortion", text);
  AppendVector(Eigen::Map<const Eigen::VectorXd>(
                   intrinsic.distortion.data(),
                   static_cast<Eigen::Index>(intrinsic.distortion.size())),
               text);
  text += "}";
}

void AppendLine(LineTrackId id, const LineLandmark& landmark,
                std::string& text) {
  text += "{";
  AppendKey("id", text);
  AppendInteger(id.value(), text);
  AppendKey("direction", text);
  AppendVector(landmark.line.direction, text);
  AppendKey("moment", text);
  AppendVector(landmark.line.moment, text);
  AppendKey("start", text);
  AppendVector(landmark.start, text);
  AppendKey("end", text);
  AppendVector(landmark.end, text);
  AppendTrackMember(landmark.observations, text);
  text += "}";
}

}  // namespace

void AppendOwnSections(const Scene& scene, std::string& text) {
  const auto append_features = [](const auto& entry, std::string& out) {
    AppendFeatures(entry.first, entry.second, out);
  };
  const auto append_given_intrinsic = [](const auto& entry, std::string& out) {
    AppendGivenIntrinsic(entry.first, entry.second, out);
  };
  const auto append_relative_pose = [](const auto& entry, std::string& out) {
    AppendRelativePose(entry.second, out);
  };
  const auto append_track = [](const auto& entry, std::string& out) {
    AppendTrack(entry.first.value(), entry.second, out);
  };
  const auto append_line = [](const auto& entry, std::string& out) {
    AppendLine(entry.first, entry.second, out);
  };
  text += "\"version\": 4,\n";
  AppendSection("given_intrinsics", scene.given_intrinsics,
                append_given_intrinsic, text);
  text += ",\n";
  AppendSection("features", scene.features, append_features, text);
  text += ",\n";
  AppendSection("relative_poses", scene.relative_poses, append_relative_pose,
                text);
  text += ",\n";
  AppendSection("point_tracks", scene.point_tracks, append_track, text);
  text += ",\n";
  AppendSection("line_tracks", scene.line_tracks, append_track, text);
  text += ",\n";
  AppendSection("scale_ratios", scene.scale_ratios, AppendScaleRatio, text);
  text += ",\n";
  AppendSection("line_structure", scene.line_structure, append_line, text);
  text += ",\n\"coplanar_pairs\": [";
  for (const CoplanarPair& pair : scene.coplanar_pairs) {
    AppendIds(text, pair.first, pair.second);
  }
  text += "]";
}

}  // namespace lowlap
