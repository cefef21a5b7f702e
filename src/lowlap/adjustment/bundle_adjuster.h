#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

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

/// Which parts of an intrinsic are unknowns.
struct IntrinsicRefinement {
  bool focal = false;  // fx and fy, each
  bool principal_point = false;
  bool distortion = false;

  bool Any() const { return focal || principal_point || distortion; }
};

struct AdjustmentOptions {
  bool use_points = true;
  bool use_lines = true;
  bool use_coplanar = true;  // needs use_lines
  AdjustedCoplanarResidual coplanar_residual =
      AdjustedCoplanarResidual::kTransfer;

  /// The intrinsics to refine; those not named stay fixed.
  std::map<IntrinsicId, IntrinsicRefinement> refine_intrinsics;

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
  double min_two_view_line_overlap = 0.2;

  int max_iterations = 100;  // of each solve
  /// The final solve ends when the cost changes by less than this share; those
  /// before it at 1e-5.
  double function_tolerance = 1e-8;

  /// Covariances of the centres, from the Hessian at the solution.
  bool compute_center_covariances = false;

  /// kInvalidArgument for values without a meaning.
  Status Validate() const;
};

/// One kind of residual (points, lines, coplanar pairs). "Observations" of the
/// coplanar kind are the pairs.
struct KindAdjustment {
  std::size_t landmarks = 0;  // with observations in use, at the end
  std::size_t observations_used = 0;
  std::size_t observations_dropped = 0;  // candidates not in use at the end
  /// Of the observations in use: at the start, and at the end.
  double initial_rmse_px = 0;
  double final_rmse_px = 0;
  double stddev_px = 0;     // robust noise level; weight = 1 / stddev^2
  double threshold_px = 0;  // a contrario; also the scale of the robust loss
};

/// One run of the solver.
struct SolveReport {
  std::string
      stage;  // "fixed rotations", "everything", "round 1", ..., "final"
  std::size_t residuals = 0;
  std::size_t parameters = 0;
  double initial_cost = 0;  // in units of the noise, halved squares
  double final_cost = 0;
  int iterations = 0;
  bool converged = false;
  double seconds = 0;
};

struct AdjustmentSummary {
  double initial_cost = 0;  // of the first solve
  double final_cost = 0;    // of the last; its thresholds may differ
  KindAdjustment points;
  KindAdjustment lines;
  KindAdjustment coplanar;

  std::size_t poses_adjusted = 0;
  /// Left where they were: nothing that is in use observes them.
  std::vector<PoseId> poses_without_observations;
  /// Sets of poses that share structure; each has a gauge of its own.
  std::size_t components = 0;
  /// Observations of the input's landmarks in views without pose or intrinsic;
  /// they are not in the result.
  std::size_t observations_without_camera = 0;
  /// Landmarks of the input that are gone at the end, and new ones.
  std::size_t landmarks_removed = 0;
  std::size_t landmarks_added = 0;

  std::vector<SolveReport> solves;
  int iterations = 0;  // over all solves
  int outlier_rounds = 0;
  bool converged = false;  // last solve, and the rounds came to rest
  double seconds = 0;

  /// World units squared, in the gauge of the adjustment (the reference pose
  /// and the length of one baseline per component have none). Empty unless
  /// asked for.
  std::map<PoseId, Mat3> center_covariances;
};

/// Bundle adjustment of scene->poses, structure, line_structure and, on
/// request, intrinsics; scene->coplanar_pairs hold lines together.
///
/// Minimises  sum over kinds  1/s^2  sum rho(|r|^2),  with the residuals (px)
///   point    projection of X - observed pixel                             (2)
///   line     distances of a segment's end points to the projected line    (2)
///   pair     see AdjustedCoplanarResidual; divided by the square root of the
///   mean
///            number of pairs of its two lines, so that n lines of one plane
///            do not count n^2 times
/// where s is the kind's noise level and rho the Cauchy loss whose scale is the
/// kind's a-contrario threshold, both from the residuals at the beginning of
/// each solve. A line in two views and no pair constrains nothing; it is
/// triangulated again at the end.
///
/// Gauge, per component: one camera is held, and the length of its longest
/// baseline. The result is equivariant to similarities of the input.
///
/// Deterministic: the same for any number of threads.
///
/// Degenerate: poses without observations keep their value and are named in
/// the summary. Errors, with the scene unchanged: kInvalidArgument (options,
/// null scene), kInvalidScene (values that are not finite, dangling ids),
/// kInsufficientData (no structure of the enabled kinds in two posed views),
/// kNumerical (the solver found no usable solution), kCancelled.
///
/// Source: Salaün, Marlet, Monasse 2017, section 5; what is different, and why:
/// robust losses, weights, gauge, outlier rounds, points of two views.
Result<AdjustmentSummary> AdjustScene(Scene* scene,
                                      const AdjustmentOptions& options,
                                      const RunContext& context);

}  // namespace lowlap
