#pragma once

#include <vector>

#include "lowlap/robust/internal/a_contrario.h"

namespace lowlap {

/// Noise level of one kind of residual, and the error at which an observation
/// of the kind is no longer believed.
struct NoiseScale {
  double stddev_px = 0;     // of one component of the residual
  double threshold_px = 0;  // of the error
};

struct NoiseBounds {
  double min_threshold_px = 0.5;
  double max_threshold_px = 200;
  /// Returned (within the bounds) where fewer than kMinErrors errors are known
  /// or no threshold is meaningful.
  NoiseScale fallback{0.5, 1.5};
};

inline constexpr int kMinErrors = 8;

/// The threshold that separates the errors from those of the background law
/// with the least number of false alarms, and the noise level of the errors
/// below it: their median over `unit_median`, the median error at unit noise
/// (kMedianOfNorm).
///
/// Errors with little redundancy (points of two views, ...) should be scaled up
/// to what they would be without their own landmark's freedom. The noise level
/// is at least a twentieth of the threshold's lower bound.
NoiseScale EstimateNoise(const std::vector<double>& errors_px,
                         const BackgroundLaw& law, double unit_median,
                         const NoiseBounds& bounds);

}  // namespace lowlap
