#pragma once

#include "lowlap/averaging/scene_poses.h"

namespace lowlap {

/// Doubt spreads: adds the warning kDoubtfulNeighbors for the placed views that
/// the firm evidence does not hold together with the largest set once the views
/// of all other warnings are gone, in place of an earlier such warning.
void WarnOfHangingViews(PoseSummary* summary);

}  // namespace lowlap
