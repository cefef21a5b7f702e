#pragma once

#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/robust/internal/a_contrario.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"

namespace lowlap {

/// PixelUnit of the mean diagonal. Thresholds and residuals of two-view
/// estimators are in pixels of the estimation, those of a RelativePose in
/// pixels of the images.
double PixelUnit(const TwoViewInput& input);

/// The usable matches and the crossings of matched lines in random order.
struct ShuffledMatches {
  static constexpr int kCrossing = -1;

  PointPairs pairs;
  std::vector<int> match_of_pair;  // index into point_matches, or kCrossing
};

ShuffledMatches ShuffleMatches(const TwoViewInput& input, Random& random);

/// Those at the indices, in their order.
ShuffledMatches SomeOf(const ShuffledMatches& matches,
                       const std::vector<int>& indices);

/// BackgroundLaw::Sampson of the image where chance is larger, in pixels of the
/// estimation.
BackgroundLaw SampsonLaw(const TwoViewInput& input);

}  // namespace lowlap
