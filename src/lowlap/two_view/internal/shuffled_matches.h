#pragma once

#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/robust/internal/a_contrario.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"

namespace lowlap {

/// The usable matches and the crossings of matched lines in random order.
struct ShuffledMatches {
  static constexpr int kCrossing = -1;

  PointPairs pairs;
  std::vector<int> match_of_pair;  // index into point_matches, or kCrossing
};

ShuffledMatches ShuffleMatches(const TwoViewInput& input, Random& random);

/// BackgroundLaw::Sampson of the image where chance is larger.
BackgroundLaw SampsonLaw(const TwoViewInput& input);

}  // namespace lowlap
