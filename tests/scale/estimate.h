#pragma once

#include <gtest/gtest.h>

#include "lowlap/scale/scale_estimator.h"
#include "scale/synthetic_triplet.h"

namespace lowlap::testing {

/// What the estimator of these options says of a triplet that it can read.
inline ScaleRatio EstimateRatio(const TripletView& view,
                                const ScaleOptions& options = {}) {
  const Result<ScaleRatio> ratio = MakeScaleEstimator(options)->Estimate(view);
  EXPECT_TRUE(ratio.has_value()) << ratio.error().ToString();
  return *ratio;
}

/// Lines that are seen in two views each, and nothing else.
inline SyntheticTripletOptions PairsOnly(int num_lines, double noise_px,
                                         double wrong_share) {
  SyntheticTripletOptions options;
  options.num_lines_ij = options.num_lines_jk = num_lines;
  options.noise_px = noise_px;
  options.wrong_share = wrong_share;
  return options;
}

}  // namespace lowlap::testing
