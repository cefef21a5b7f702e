#pragma once

#include <map>
#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/ids.h"

namespace lowlap {

/// Relative poses with their evidence, 1 - min(0, log10 NFA).
using EvidenceOfPairs = std::map<ViewPair, double>;

/// Sets of views that the relative poses in use join to the others with little
/// more evidence than others have that contradict these and were rejected. For
/// every rejected pair whose views are joined, the cut of least evidence
/// between the two is looked at: it is contested if the rejected pairs across
/// it have more than half the evidence of those in use. Views that eight ways
/// join are not contested. Cost: eight searches of the graph for each rejected
/// pair.
std::vector<Contest> FindContests(const EvidenceOfPairs& in_use,
                                  const EvidenceOfPairs& rejected);

/// The same where one camera joins a set of views to the others, so that the
/// ratios across it say how large they are: these are contested if the rejected
/// pairs that pass the camera by have more than half the evidence of the best
/// of them. (What misleads one ratio across a camera misleads the next.)
std::vector<Contest> FindScaleContests(
    const EvidenceOfPairs& in_use, const std::map<ViewTriplet, double>& ratios,
    const EvidenceOfPairs& rejected);

}  // namespace lowlap
