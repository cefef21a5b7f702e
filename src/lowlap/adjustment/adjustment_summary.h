#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/core/ids.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// What became of the tracks of one kind. Every track is counted once, in
/// `landmarks` or in one of the reasons after it.
struct TriangulationSummary {
  std::size_t tracks = 0;
  std::size_t landmarks = 0;
  std::size_t two_view_landmarks = 0;  // of `landmarks`
  std::size_t too_few_views = 0;       // fewer than two with pose and intrinsic
  std::size_t inconsistent = 0;        // no two observations that agree
  std::size_t behind_camera = 0;
  std::size_t uncertain = 0;    // depth not determined, see the options
  std::size_t implausible = 0;  // lines: segments that do not overlap

  std::size_t observations = 0;          // of all tracks, in usable views
  std::size_t observations_used = 0;     // of the landmarks
  std::size_t observations_dropped = 0;  // of landmarks, beyond the threshold
  double threshold_px = 0;
};

struct StructureSummary {
  TriangulationSummary points;
  TriangulationSummary lines;
  /// Coplanar inliers of the meaningful ratios, and why some are not pairs.
  std::size_t coplanar_inliers = 0;
  std::size_t coplanar_without_lines = 0;  // a line was not triangulated
  std::size_t coplanar_parallel = 0;       // or both are one line
  std::size_t coplanar_duplicates = 0;     // already a pair
  std::size_t coplanar_pairs = 0;
  double seconds = 0;
};

/// One kind of residual (points, lines, coplanar pairs). "Observations" of the
/// coplanar kind are the pairs.
struct KindAdjustment {
  std::size_t landmarks = 0;  // with observations in use, at the end
  std::size_t observations_used = 0;
  std::size_t observations_dropped = 0;  // candidates not in use at the end
  /// Pairs that agree with the rest, but were not needed.
  std::size_t observations_surplus = 0;
  /// Root mean square, without weights, of the distances in the photographs'
  /// own pixels: of points from their projections, of the ends of segments from
  /// the images of the lines. Of what is in use; nullopt: nothing is.
  std::optional<double> initial_rmse_px;
  std::optional<double> final_rmse_px;
  // Of errors weighted by the shapes of points and the noise of segments.
  double stddev_px = 0;     // robust noise level; weight = 1 / stddev^2
  double threshold_px = 0;  // a contrario
};

/// One run of the solver.
struct SolveReport {
  /// "fixed rotations", "everything", "round 1", ..., "final"; "again: ..."
  /// with a wide gate, "lines first: ..." and "points first: ..." from the
  /// start with one kind.
  std::string stage;
  std::size_t residuals = 0;
  std::size_t parameters = 0;
  double initial_cost = 0;  // in units of the noise, halved squares
  double final_cost = 0;
  int iterations = 0;
  bool converged = false;
  double seconds = 0;
};

/// A calibration that was held, and that the images contradict.
struct CalibrationPreference {
  /// Usually one; all of a scene with many, which are tested together.
  std::vector<IntrinsicId> intrinsics;
  IntrinsicRefinement parts;    // those that the images would change
  IntrinsicRefinement refined;  // those that were free anyway
  /// Of the first intrinsic; what the images prefer is a first-order estimate.
  Intrinsic held;
  Intrinsic preferred;
  /// How far the two are apart, in standard deviations of the estimate.
  double deviations = 0;
};

/// Where the adjustment ended from another start, and explains what more than
/// two views show to within what one observation says.
struct RivalOptimum {
  std::string start;  // "points and lines", "lines first", "points first"
  /// How far its centres are, after the least similarity, in world units: of
  /// those that are outside the 95 % regions of the covariances.
  std::map<PoseId, double> distances;
};

struct AdjustmentSummary {
  double initial_cost = 0;  // of the first solve
  double final_cost = 0;    // of the last; its thresholds may differ
  KindAdjustment points;
  KindAdjustment lines;
  KindAdjustment coplanar;
  /// With CoplanarTies other than kPairs.
  std::size_t planes = 0;
  std::size_t landmarks_on_planes = 0;
  /// Those that held rotations.
  std::size_t directions = 0;

  /// How far the errors of points follow their shapes (0: they are round).
  double point_shape_exponent = 0;

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

  /// Empty where noise explains what there is.
  std::vector<CalibrationPreference> calibration_preferences;

  /// With AdjustmentOptions::estimate_uncertainty; the deviations hold them.
  std::vector<RivalOptimum> rivals;

  std::vector<SolveReport> solves;
  int iterations = 0;  // over all solves
  int outlier_rounds = 0;
  bool converged = false;  // last solve, and the rounds came to rest
  double seconds = 0;

  /// What the observations, parts of the scene that err as one, and a
  /// calibration that is off leave open of the scale ratios and relative poses
  /// of the scene whose views share structure, even over others, at the
  /// adjusted centres: standard deviations of log(|c3 - c2| / |c2 - c1|), and
  /// of the direction of c2 - c1 along the axis in which it is known least.
  std::map<ViewTriplet, double> log_ratio_stddevs;
  std::map<ViewPair, double> direction_stddevs_rad;
};

}  // namespace lowlap
