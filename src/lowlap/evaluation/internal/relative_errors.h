#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Error of one relative pose: the angle between the rotations, and between
/// the directions (with their sign: a flipped baseline is wrong by 180). No
/// direction error where the true centres coincide.
struct RelativePoseError {
  ViewPair views;
  double rotation_error_deg = 0;
  std::optional<double> direction_error_deg;
};

struct RelativePoseEvaluation {
  std::vector<RelativePoseError> pairs;
  int num_without_truth = 0;
  ErrorStatistics rotation_deg;
  ErrorStatistics direction_deg;
};

/// scene.relative_poses against the truth; no alignment is involved.
RelativePoseEvaluation EvaluateRelativePoses(const Scene& scene,
                                             const GroundTruth& truth);

/// Error of one scale ratio, log_ratio - true log ratio, where the truth is
///   log( |C_last - C_middle| / |C_middle - C_first| ).
struct ScaleRatioError {
  ViewTriplet views;
  RatioVerdict verdict = RatioVerdict::kNoCandidates;
  double true_log_ratio = 0;
  double log_error = 0;  // 0.01 is about 1 per cent of scale
  double stddev = 0;     // as stated by the estimator
};

struct ScaleRatioEvaluation {
  std::vector<ScaleRatioError> ratios;  // meaningful or not; not kNoCandidates
  int num_no_candidates = 0;
  int num_without_truth = 0;      // a view without truth, or no true baseline
  ErrorStatistics abs_log_error;  // of the meaningful ratios
};

ScaleRatioEvaluation EvaluateScaleRatios(const Scene& scene,
                                         const GroundTruth& truth);

std::string ToText(const RelativePoseEvaluation& evaluation);
std::string ToText(const ScaleRatioEvaluation& evaluation);

}  // namespace lowlap
