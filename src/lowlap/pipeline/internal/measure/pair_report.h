#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Takes the numbers of inliers of accepted pairs from the scene.
void CountInliers(const Scene& scene, std::vector<PairReport>* pairs);

/// For people, where not one pair was accepted: how many were tried, and why
/// the one with the most matches was not.
std::string ExplainNoPose(const std::vector<PairReport>& pairs);

/// The views that no accepted pair holds, by id, each with why: what is wrong
/// with its image (`failed`); "no parallax", if a pair of it was refused for
/// that; the reason of its pair of most matches; or that it is in no pair.
std::vector<UnrelatedView> FindUnrelatedViews(
    const std::map<ViewId, View>& all, const std::vector<PairReport>& pairs,
    const std::map<ViewId, Error>& failed);

}  // namespace lowlap
