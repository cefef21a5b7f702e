#pragma once

#include <cstddef>
#include <cstdint>

#include "lowlap/core/result.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

struct SimulatedRatioOptions {
  /// Standard deviation of the logarithm of a right ratio; also what every
  /// ratio says of itself.
  double log_stddev = 0.02;
  /// Share of the ratios that are wrong: off by a factor between min_factor and
  /// max_factor, up or down. They are as meaningful as the others.
  double wrong_share = 0.0;
  /// So is every ratio of a relative pose whose rotation is more than 10
  /// degrees off the true one.
  bool wrong_beside_wrong_poses = false;
  double min_factor = 1.2;
  double max_factor = 7.0;
  /// An even random choice of so many triplets; 0: all.
  std::size_t max_ratios = 0;
  std::uint64_t seed = 0;

  Status Validate() const;
};

/// Fills scene.scale_ratios with a ratio for every triplet of the scene's
/// relative poses (FindTriplets) that has a true one, as if features had been
/// measured: for graphs too large, or of no interest, to carry features. What
/// is drawn for a triplet does not depend on the others, and a greater
/// wrong_share makes the same ratios wrong, and more. kInvalidArgument names
/// the option that is out of range.
Status SimulateRatios(const SimulatedRatioOptions& options,
                      SyntheticScene* synthetic);

}  // namespace lowlap
