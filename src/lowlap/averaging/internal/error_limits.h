#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/types.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {

/// How far a relative pose may be off before it is called false: `reach`
/// standard deviations, its stated one or that of all residuals, whichever is
/// larger, but at least what no deviation calls false (PoseOptions).
struct ErrorLimits {
  double reach = 0;
  double least_false_rad = 0;

  double RotationRad(double of_residuals_rad, double stated_rad) const {
    return std::max(reach * std::max(of_residuals_rad, stated_rad),
                    least_false_rad);
  }
  double DirectionRad(double of_residuals_rad, double stated_rad) const {
    return std::max(reach * std::max(of_residuals_rad, stated_rad),
                    3 * least_false_rad);
  }
};

inline ErrorLimits LimitsOf(const PoseOptions& options) {
  return {options.outlier_reach, RadFromDeg(options.least_false_deg)};
}

/// Robust standard deviation per axis of relative poses whose errors have these
/// norms; kDimension: 3 of rotations, 2 of directions.
template <int kDimension>
double ResidualStddev(std::vector<double> norms_rad) {
  return std::max(Median(std::move(norms_rad)) / kMedianOfNorm<kDimension>,
                  kPoseErrorFloorRad);
}

}  // namespace lowlap
