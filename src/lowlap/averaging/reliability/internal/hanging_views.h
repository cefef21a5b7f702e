#pragma once

#include "lowlap/averaging/scene_poses.h"

namespace lowlap {

/// Doubt spreads: adds the warning kDoubtfulNeighbors for the placed views that
/// the firm evidence does not hold together with the largest set once the views
/// of all other warnings are gone, in place of an earlier such warning. Two
/// views are no such set if more are placed: they hold each other whatever is
/// wrong. Nor is one of two sets of the same size, or one of fewer than half of
/// the placed views: nothing says that it is in its place among the others.
void WarnOfHangingViews(PoseSummary* summary);

}  // namespace lowlap
