#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/evaluation/statistics.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// How well poses and structure agree with what they were computed from: what
/// can be said without true cameras.
struct Consistency {
  /// Angles between the direction of a relative pose (i, j) and that of the
  /// solved baseline, R_j (C_i - C_j), in degrees.
  ErrorStatistics direction_deg;
  double mean_baseline = 0;  // of the same relative poses, world units
  /// | log(|C_k - C_j| / |C_j - C_i|) - log ratio | of the meaningful scale
  /// ratios (i, j, k); 0.01 is about 1 per cent of scale. Parts that were put
  /// together at an arbitrary scale show here, and not in the directions.
  ErrorStatistics abs_log_ratio;
  /// Of the points of the structure, over all their observations, pixels.
  std::size_t num_points = 0;
  double reprojection_rmse_px = 0;
};

/// Judges scene.poses and scene.structure by the relative poses (but for
/// `outliers`) and the scale ratios between views with a pose. Pairs whose
/// solved centres coincide count with 90 degrees; ratios of such pairs are left
/// out, like observations behind their camera.
Consistency EvaluateConsistency(const Scene& scene,
                                const std::vector<ViewPair>& outliers);

}  // namespace lowlap
