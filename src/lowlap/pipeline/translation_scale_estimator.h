#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What TranslationScaleEstimator finds.
struct TranslationEstimate {
  /// log(lambda(middle, last) / lambda(first, middle)) of every path of two
  /// relative poses that are kept, with its interval, its support by kind of
  /// evidence and its verdict: only kMeaningful ones bear weight.
  std::vector<ScaleRatio> ratios;
  /// Of the placed views, all in one scale. Gauge: the given rotations if there
  /// are any, else the first placed view has rotation identity; that view's
  /// centre is 0, and the mean length of the relative poses in use is 1.
  std::map<ViewId, Pose> poses;
  std::vector<ViewId> unplaced;
  /// What was left out and what is doubtful, and why.
  PoseSummary summary;
};

/// The translation step of a structure-from-motion program that has a view
/// graph in memory: views with features, and relative poses with the matches
/// that bear them out, go in; relative scales and camera centres come out.
/// Points and lines that three views share are used where there are any;
/// coplanar lines relate the scales of two relative poses where there are none
/// (Salaün, Marlet and Monasse 2017). Line matches are joined to tracks
/// (BuildLineTracks), so that a broken line counts once. Nothing is refined:
/// bundle adjustment is the host's, or AdjustScene's.
///
/// Pixels: the centre of the top-left pixel is (0, 0). Frames:
/// x_cam = rotation (X - centre); +z forward, x right, y down.
///
/// Views and relative poses may be added in any order; what is wrong with them
/// is reported by Estimate.
class TranslationScaleEstimator {
 public:
  TranslationScaleEstimator() = default;
  /// The estimator of ratios, the averaging strategy, and their options; those
  /// of structure and adjustment are not looked at.
  explicit TranslationScaleEstimator(SolveOptions options);

  /// A view with its camera; `points_px` 2 x n, `segments_px` 4 x m, a column
  /// (x1, y1, x2, y2) each, all as detected (with distortion).
  void AddView(ViewId view, const Intrinsic& intrinsic,
               const Eigen::Matrix2Xd& points_px,
               const Eigen::Matrix4Xd& segments_px = {});
  /// The same for a camera without distortion: `calibration_px` = [fx 0 px;
  /// 0 fy py; 0 0 1].
  void AddView(ViewId view, const Mat3& calibration_px, int width_px,
               int height_px, const Eigen::Matrix2Xd& points_px,
               const Eigen::Matrix4Xd& segments_px = {});

  /// x_second = rotation x_first + lambda translation, lambda > 0 unknown; the
  /// length of `translation` is ignored. Inlier matches, 2 x n: a column holds
  /// the index of a point (segment) in `first` and in `second`.
  void AddRelativePose(ViewId first, ViewId second, const Mat3& rotation,
                       const Vec3& translation,
                       const Eigen::Matrix2Xi& point_matches,
                       const Eigen::Matrix2Xi& line_matches = {});

  /// A global rotation that the host has found already. With one for every view
  /// they are kept as they are, and relative poses that contradict them are
  /// left out; otherwise rotations are averaged here.
  void SetRotation(ViewId view, const Mat3& cam_from_world);

  /// Errors: kInvalidScene naming the view or relative pose (given twice, of
  /// unknown views, not a rotation, an index out of range); rotations for some
  /// views only; those of the averaging strategy; kCancelled.
  Result<TranslationEstimate> Estimate(const RunContext& context = {}) const;

 private:
  void Fail(std::string message);

  SolveOptions options_;
  Scene scene_;
  std::map<ViewId, Mat3> cam_from_world_;
  std::optional<Error> error_;  // the first
};

}  // namespace lowlap
