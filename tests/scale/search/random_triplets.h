#pragma once

#include <memory>

#include "lowlap/core/internal/random.h"
#include "lowlap/scale/evidence/internal/coplanar_lines.h"
#include "lowlap/scale/evidence/internal/trifocal.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "scale/synthetic_triplet.h"

namespace lowlap::testing {

/// Anything from three features to some forty of each kind.
inline SyntheticTripletOptions RandomOptions(std::uint64_t seed) {
  Random random(seed);
  SyntheticTripletOptions options;
  const int largest = random.Index(10) == 0 ? 40 : 12;
  options.num_points = static_cast<int>(random.Index(largest));
  options.num_lines = static_cast<int>(random.Index(largest));
  options.num_lines_ij = static_cast<int>(random.Index(largest + 4));
  options.num_lines_jk = static_cast<int>(random.Index(largest + 4));
  options.noise_px = random.Uniform(0, 2);
  options.wrong_share = random.Uniform(0, 0.9);
  options.pure_noise = random.Index(5) == 0;
  if (random.Index(2) == 0) {
    options.rotation_error_deg = 0.1;
    options.direction_error_deg = 0.5;
  }
  return options;
}

inline RatioSupport Support(const TripletView& view) {
  return RatioSupport(GatherEvidence({std::make_shared<TrifocalPointKind>(),
                                      std::make_shared<TrifocalLineKind>(),
                                      std::make_shared<CoplanarLinesKind>()},
                                     view));
}

}  // namespace lowlap::testing
