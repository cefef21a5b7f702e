#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/scale/scale_estimator.h"
#include "scale/synthetic_triplet.h"

namespace lowlap::testing {

/// Simulated triplets of one kind of feature (or all), with one noise, share of
/// wrong features, and relative poses that are true or as wrong as their
/// covariance says.
struct IntervalClass {
  bool points = false, lines = false, pairs = false;
  double noise_px = 1;
  double wrong_share = 0;
  bool noisy_poses = false;

  std::string Kinds() const {
    return points && lines ? "mixed"
           : points        ? "points"
           : lines         ? "lines"
                           : "pairs";
  }
  std::string Name() const {
    return Kinds() + ", " + std::to_string(noise_px).substr(0, 3) + " px, " +
           std::to_string(static_cast<int>(100 * wrong_share)) + " % wrong, " +
           (noisy_poses ? "noisy" : "true") + " poses";
  }
};

inline std::vector<IntervalClass> AllIntervalClasses() {
  std::vector<IntervalClass> classes;
  for (const int kinds : {1, 2, 4, 7}) {
    for (const double noise_px : {0.5, 1.0, 2.0}) {
      for (const double wrong_share : {0.0, 0.3, 0.5}) {
        for (const bool noisy_poses : {false, true}) {
          classes.push_back({(kinds & 1) != 0, (kinds & 2) != 0,
                             (kinds & 4) != 0, noise_px, wrong_share,
                             noisy_poses});
        }
      }
    }
  }
  return classes;
}

/// Of the ratios that are called meaningful.
struct IntervalCoverage {
  int meaningful = 0;
  int right = 0;   // off by less than 5 standard deviations, or 10 %
  int inside = 0;  // of the right ones, within the interval of 95 %

  double Share() const { return static_cast<double>(inside) / right; }
  void Add(const IntervalCoverage& other) {
    meaningful += other.meaningful;
    right += other.right;
    inside += other.inside;
  }
};

/// Tries triplets until `wanted` are right, up to `most`. Seeds differ from
/// class to class.
inline IntervalCoverage MeasureCoverage(const IntervalClass& of, int wanted,
                                        int most, std::uint64_t class_seed) {
  IntervalCoverage coverage;
  for (int n = 0; n < most && coverage.right < wanted; ++n) {
    const std::uint64_t seed = 1000003 * (1000 * class_seed + n) + 17;
    Random random(seed + 1);
    SyntheticTripletOptions options;
    if (of.points) options.num_points = 10 + static_cast<int>(random.Index(20));
    if (of.lines) options.num_lines = 20 + static_cast<int>(random.Index(15));
    if (of.pairs) {
      options.num_lines_ij = 50 + static_cast<int>(random.Index(20));
      options.num_lines_jk = 50 + static_cast<int>(random.Index(20));
    }
    options.noise_px = of.noise_px;
    options.wrong_share = of.wrong_share;
    if (of.noisy_poses) {
      options.rotation_error_deg = 0.1;
      options.direction_error_deg = 0.5;
    }
    const SyntheticTriplet triplet = MakeSyntheticTriplet(options, seed);
    const Result<ScaleRatio> ratio =
        MakeScaleEstimator({})->Estimate(triplet.view);
    if (!ratio || ratio->verdict != RatioVerdict::kMeaningful) continue;
    ++coverage.meaningful;
    const double error = std::abs(ratio->log_ratio - triplet.true_log_ratio);
    if (error >= std::max(0.1, 5 * ratio->log_ratio_stddev)) continue;
    ++coverage.right;
    coverage.inside += error < 1.96 * ratio->log_ratio_stddev;
  }
  return coverage;
}

}  // namespace lowlap::testing
