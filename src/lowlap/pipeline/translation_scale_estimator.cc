#include "lowlap/pipeline/translation_scale_estimator.h"

#include <string>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/matching/internal/tracks.h"
#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"
#include "lowlap/pipeline/internal/given_rotations.h"
#include "lowlap/scene/validation.h"

namespace lowlap {
namespace {

std::string Name(ViewId view) { return "view " + std::to_string(view.value()); }

std::vector<FeatureMatch> Matches(const Eigen::Matrix2Xi& columns,
                                  bool swapped) {
  std::vector<FeatureMatch> matches;
  matches.reserve(columns.cols());
  for (Eigen::Index n = 0; n < columns.cols(); ++n) {
    // A negative index becomes one that no view has.
    matches.push_back({static_cast<FeatureIndex>(columns(swapped ? 1 : 0, n)),
                       static_cast<FeatureIndex>(columns(swapped ? 0 : 1, n))});
  }
  return matches;
}

}  // namespace

TranslationScaleEstimator::TranslationScaleEstimator(SolveOptions options)
    : options_(std::move(options)) {}

void TranslationScaleEstimator::Fail(std::string message) {
  if (error_) return;
  error_ = Error{ErrorCode::kInvalidScene, std::move(message), {}, {}};
}

void TranslationScaleEstimator::AddView(ViewId view, const Intrinsic& intrinsic,
                                        const Eigen::Matrix2Xd& points_px,
                                        const Eigen::Matrix4Xd& segments_px) {
  View added;
  added.width_px = intrinsic.width_px;
  added.height_px = intrinsic.height_px;
  added.intrinsic_id = view.value();
  added.pose_id = view.value();
  if (!scene_.views.emplace(view, added).second) {
    return Fail(Name(view) + " is given twice");
  }
  scene_.intrinsics[view.value()] = intrinsic;
  ViewFeatures& features = scene_.features[view];
  for (Eigen::Index n = 0; n < points_px.cols(); ++n) {
    features.points_px.emplace_back(points_px.col(n));
  }
  for (Eigen::Index n = 0; n < segments_px.cols(); ++n) {
    LineSegment segment;
    segment.start_px = segments_px.col(n).head<2>();
    segment.end_px = segments_px.col(n).tail<2>();
    features.segments.push_back(segment);
  }
}

void TranslationScaleEstimator::AddView(ViewId view, const Mat3& calibration_px,
                                        int width_px, int height_px,
                                        const Eigen::Matrix2Xd& points_px,
                                        const Eigen::Matrix4Xd& segments_px) {
  if (!(calibration_px.row(2) == Vec3::UnitZ().transpose()) ||
      calibration_px(0, 1) != 0 || calibration_px(1, 0) != 0) {
    return Fail(Name(view) +
                ": a calibration matrix is [fx 0 px; 0 fy py; 0 0 1]");
  }
  Intrinsic pinhole;
  pinhole.width_px = width_px;
  pinhole.height_px = height_px;
  pinhole.fx_px = calibration_px(0, 0);
  pinhole.fy_px = calibration_px(1, 1);
  pinhole.principal_point_px = calibration_px.topRightCorner<2, 1>();
  AddView(view, pinhole, points_px, segments_px);
}

void TranslationScaleEstimator::AddRelativePose(
    ViewId first, ViewId second, const Mat3& rotation, const Vec3& translation,
    const Eigen::Matrix2Xi& point_matches,
    const Eigen::Matrix2Xi& line_matches) {
  const bool swapped = second < first;
  const std::string name =
      "relative pose of " + Name(first) + " and " + Name(second);
  if (!(translation.norm() > 0) || !translation.allFinite()) {
    return Fail(name + " has no direction");
  }
  RelativePose pose;
  pose.views = swapped ? ViewPair{second, first} : ViewPair{first, second};
  RigidTransform transform{rotation, translation.normalized()};
  if (swapped) transform = transform.Inverse();
  pose.rotation = transform.rotation;
  pose.direction = transform.translation.normalized();
  pose.point_inliers = Matches(point_matches, swapped);
  pose.line_inliers = Matches(line_matches, swapped);
  if (!scene_.relative_poses.emplace(pose.views, pose).second) {
    Fail(name + " is given twice");
  }
}

void TranslationScaleEstimator::SetRotation(ViewId view,
                                            const Mat3& cam_from_world) {
  cam_from_world_[view] = cam_from_world;
}

Result<TranslationEstimate> TranslationScaleEstimator::Estimate(
    const RunContext& context) const {
  if (error_) return tl::unexpected<Error>(*error_);
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene_));
  LOWLAP_RETURN_IF_ERROR(options_.Validate());
  for (const auto& [view, rotation] : cam_from_world_) {
    if (scene_.views.count(view) == 0 ||
        !(RotationDefect(rotation) <= kUnitTolerance)) {
      return MakeError(ErrorCode::kInvalidScene,
                       "the rotation of " + Name(view) +
                           " is of an unknown view, or is no rotation");
    }
  }
  if (!cam_from_world_.empty() &&
      cam_from_world_.size() != scene_.views.size()) {
    return MakeError(ErrorCode::kInvalidScene,
                     "rotations are given for " +
                         std::to_string(cam_from_world_.size()) + " of " +
                         std::to_string(scene_.views.size()) +
                         " views; give all or none");
  }

  Scene scene = scene_;
  scene.line_tracks = BuildLineTracks(scene, LineTrackOptions());
  Result<PoseSummary> summary;
  if (cam_from_world_.empty()) {
    LOWLAP_ASSIGN_OR_RETURN(
        auto composed, ComposeSolution(&scene, options_, context, nullptr));
    LogDecisions(composed.start.motions, scene, context);
    summary = std::move(composed.poses);
  } else {
    summary = SolveGivenRotations(cam_from_world_, options_, context, nullptr,
                                  &scene);
  }
  LOWLAP_RETURN_IF_ERROR(summary);

  TranslationEstimate estimate;
  estimate.ratios = std::move(scene.scale_ratios);
  estimate.unplaced = summary->unplaced;
  estimate.summary = std::move(*summary);
  for (const auto& [view, description] : scene.views) {
    if (const Pose* pose = scene.FindPose(view)) estimate.poses[view] = *pose;
  }
  return estimate;
}

}  // namespace lowlap
