#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What is expected of the two-view step.
struct PairEvaluationOptions {
  /// A pair fails if its rotation or its direction is worse than this.
  double max_rotation_deg = 2.0;
  double max_direction_deg = 8.0;
  /// Pairs that must have a relative pose, besides the consecutive ones.
  std::vector<ViewPair> expected;

  /// kInvalidArgument unless the limits are positive and the pairs are of two
  /// views, the smaller id first.
  Status Validate() const;
};

/// One pair: measured, expected, or both.
struct PairError {
  ViewPair views;
  bool consecutive = false;
  bool has_pose = false;
  bool failed = false;
  /// Absent without a pose; the direction's also where the true centres
  /// coincide. Angles as in RelativePoseError.
  std::optional<double> rotation_error_deg;
  std::optional<double> direction_error_deg;
  int num_point_inliers = 0;
  int num_line_inliers = 0;
  double log10_nfa = 0;
};

/// Empirical quantiles, without interpolation: the least value that the given
/// share of the values does not exceed. All zero for none.
struct ErrorQuantiles {
  int count = 0;
  double median = 0;
  double p90 = 0;
  double worst = 0;
};

ErrorQuantiles QuantilesOf(std::vector<double> values);

struct PairGroupErrors {
  int num_pairs = 0;
  int num_without_pose = 0;
  int num_failed = 0;  // those without a pose included
  ErrorQuantiles rotation_deg;
  ErrorQuantiles direction_deg;
};

/// The relative poses of a scene against the truth, pair by pair.
struct PairEvaluation {
  std::vector<PairError> pairs;  // by views
  PairGroupErrors consecutive;
  PairGroupErrors all;
  int num_without_truth = 0;  // relative poses that cannot be judged
};

/// Judges every relative pose whose two views have a true pose, and adds the
/// pairs that should have one and do not: those of `options.expected`, and the
/// consecutive ones. Consecutive are views next to each other in the order of
/// the ids of all views with truth, closed to a loop by the last and the first.
/// Nothing is aligned: relative poses have no gauge.
///
/// Errors: those of options.Validate(); kInvalidArgument if an expected pair
/// names a view without truth.
Result<PairEvaluation> EvaluatePairs(const Scene& scene,
                                     const GroundTruth& truth,
                                     const PairEvaluationOptions& options = {});

/// A table for people: one line per pair, then the two groups.
std::string ToText(const PairEvaluation& evaluation);
/// A JSON object with the members' names.
std::string ToJson(const PairEvaluation& evaluation);

}  // namespace lowlap
