#pragma once

#include <vector>

#include "lowlap/two_view/internal/pair_estimator.h"

namespace lowlap {

/// Drops weak poses (RelativePose::weakness) where other relative poses join
/// their views.
///
/// The path of most evidence through the others is as strong as its weakest
/// link. A weak pose of more evidence (-log10 NFA) than that is kept. So is one
/// of more than half as much that agrees with the path in rotation, to within
/// five degrees: as little tells in contests (Contest) which of two is right,
/// and a long path may hold no scale. The others are dropped, and say so.
void DropWeakPoses(std::vector<PairEstimate>* estimates);

}  // namespace lowlap
