#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/rotations/internal/rotation_averaging.h"

namespace lowlap {

/// What the cycles of the view graph say about every measured rotation, before
/// anything is averaged.
struct CycleSupport {
  /// Estimated error of each measurement, in radians; 0 where no cycle is
  /// known.
  std::vector<double> error_rad;
  /// Cycles that were looked at, a hundred at most; 0: nothing is known about
  /// the measurement.
  std::vector<int> num_cycles;
  /// The lower quartile of error_rad over measurements with cycles: what a
  /// right measurement looks like while at most three in four are wrong.
  double typical_rad = 0;
};

/// Estimates the error of each rotation from the closing errors of the
/// triangles through it, and of the 4-cycles where it is in no triangle, by
/// message passing (Lerman and Shi 2022, "Robust group synchronization via
/// cycle-edge message passing"):
///   s_e <- sum_c w_c d_c / sum_c w_c,
///   w_c = exp(-beta sum_{f in c, f != e} s_f),
/// over the cycles c through e with closing angles d_c, with beta doubled from
/// step to step until it resolves the typical error. A cycle speaks for or
/// against a measurement only as far as its other members are trusted.
CycleSupport ScoreCycles(std::size_t num_views,
                         const std::vector<RotationMeasurement>& measurements);

}  // namespace lowlap
