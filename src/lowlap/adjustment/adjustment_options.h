#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/adjustment/refined_intrinsics.h"
#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// What the adjustment of a coplanar pair minimises. P_ab is the point of line
/// a that is closest to line b, P_ba the other way round.
enum class AdjustedCoplanarResidual {
  /// In every view of b: the distance of the ray to P_ab from the
  /// interpretation plane of b; in every view of a: P_ba and a. Reacts whatever
  /// way the plane faces.
  kTransfer,
  /// In every view that sees both: the difference of the images of P_ab and
  /// P_ba (the paper's, section 5). Blind where the plane faces the camera.
  kImageDistance,
};

/// What the coplanar kind holds together in the adjustment.
enum class CoplanarTies {
  /// The pairs of lines of the ratios (the paper's, section 5), and nothing
  /// else
  /// that the whole scene shares.
  kPairs,
  /// Those at first; at the end the planes of the scene with all that is on
  /// them, and the pairs only where there are no planes.
  kPlanes,
  kBoth,  // at the end both
};

/// How tracks become landmarks.
struct StructureOptions {
  bool use_points = true;
  bool use_lines = true;
  bool use_coplanar = true;  // needs use_lines

  /// Largest error of an observation, in pixels. 0: a contrario, from the
  /// residuals of all tracks of the kind, and at least the thresholds that the
  /// relative poses were verified with. Change it only for data whose noise is
  /// known better than its residuals tell.
  double max_point_error_px = 0;
  double max_line_error_px = 0;

  /// A point is kept if the standard deviation of its depth, propagated
  /// from the image noise, is at most this share of the depth. It takes the
  /// place of a least triangulation angle: it knows the focal length, the
  /// noise and the number of views.
  double max_relative_depth_stddev = 0.3;
  /// The same for lines, at the worse end of their extent. Lines near an
  /// epipolar plane say little and make the adjustment slow.
  double max_relative_line_depth_stddev = 0.1;

  /// A line seen in two views fits them always. It is kept if its segments,
  /// lifted onto it, share at least this part of the shorter one.
  double min_two_view_line_overlap = 0.2;

  /// Lines of a coplanar pair must differ by this angle: the meeting point of
  /// almost parallel lines is not defined by the images.
  double min_coplanar_angle_deg = 10;

  /// kInvalidArgument for values without a meaning.
  Status Validate() const;
};

struct AdjustmentOptions {
  /// Kinds that are off have no influence; their landmarks follow the poses.
  bool use_points = true;
  bool use_lines = true;
  bool use_coplanar = true;  // needs use_lines
  /// Hold poses to the measured relative poses, as far as their covariances
  /// say. It decides where structure is thin, and hardly shows elsewhere.
  bool use_relative_poses = true;
  /// Hold baselines to the measured scale ratios, likewise: without them a
  /// scale that little structure carries on may go anywhere.
  bool use_scale_ratios = true;
  /// Hold rotations to the directions of parallel lines, which all views share
  /// and which do not drift. Not with CoplanarTies::kPairs, the paper's
  /// adjustment, nor while intrinsics move.
  bool use_directions = true;
  CoplanarTies coplanar_ties = CoplanarTies::kPlanes;
  AdjustedCoplanarResidual coplanar_residual =
      AdjustedCoplanarResidual::kTransfer;

  /// A line is held by so many of its pairs at most; more of one plane say the
  /// same again, and each costs the solver time.
  int max_pairs_per_line = 3;

  /// The intrinsics to refine, and which parts of them. The rest is held.
  std::map<IntrinsicId, IntrinsicRefinement> refine_intrinsics;
  /// 0: principal points move only where refine_intrinsics says so. Else all
  /// move, and are held to the given ones with this standard deviation of each
  /// coordinate, as a share of the image diagonal: 0.0003, one pixel of six
  /// megapixels, is what a careful calibration leaves.
  double principal_point_stddev = 0;
  /// Whether the images contradict what is held of the calibration: see
  /// AdjustmentSummary::calibration_preferences.
  bool test_calibration = true;

  /// True if an intrinsic may move.
  bool MovesIntrinsics() const {
    return principal_point_stddev > 0 || !refine_intrinsics.empty();
  }

  /// First adjust centres and structure with the rotations held. Off where the
  /// rotations are worse than the centres.
  bool fixed_rotations_first = true;

  /// Rounds of dropping, re-triangulating and completing after the first
  /// solve. 0: the observations are taken as they are.
  int max_outlier_rounds = 8;
  /// The rounds end when less than this share of the observations changed.
  double outlier_round_tolerance = 1e-3;

  /// Bounds of the thresholds, which come from the residuals a contrario. The
  /// lower bound keeps exact data from rejecting its own rounding errors.
  double min_threshold_px = 0.5;
  double max_threshold_px = 200;
  /// As in StructureOptions, for landmarks that are triangulated again.
  double max_relative_depth_stddev = 0.3;
  double max_relative_line_depth_stddev = 0.1;
  double min_two_view_line_overlap = 0.2;

  int max_iterations = 100;  // of each solve
  /// The final solve ends when the cost changes by less than this share; those
  /// before it earlier.
  double function_tolerance = 1e-8;

  /// Whether poses get the covariances of their centres (Pose), and the summary
  /// the deviations of ratios and directions.
  bool estimate_uncertainty = true;

  /// kInvalidArgument for values without a meaning.
  Status Validate() const;
};

/// The kinds of features that the adjustment uses, by name: points, lines,
/// coplanar (pairs, which need lines and take them in). kInvalidArgument for
/// another name.
Status SetAdjustedFeatures(const std::vector<std::string>& features,
                           AdjustmentOptions* options);

/// CoplanarTies by name: pairs, planes, both. kInvalidArgument for another one.
Result<CoplanarTies> ParseCoplanarTies(const std::string& name);

}  // namespace lowlap
