#pragma once

#include <cstddef>
#include <map>

#include "lowlap/core/result.h"
#include "lowlap/matching/internal/tracks.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Drops the features that no relative pose, track, landmark or ratio refers
/// to, and renumbers the others.
void KeepMatchedFeatures(Scene* scene);

/// What the scene holds to estimate ratios of some pairs from: the relative
/// poses, each with the hypothesis of this number (WithHypothesis), and the
/// views, intrinsics, features and line tracks that these are about.
Scene SceneOfPairs(const Scene& scene,
                   const std::map<ViewPair, std::size_t>& hypotheses);

/// Drops what solving finds (scale ratios, poses, structure, coplanar pairs)
/// and keeps what was measured.
void DropSolution(Scene* scene);

/// Keeps at most `max_per_pair` (> 0) point inliers of every relative pose,
/// those on the longest tracks first, and builds the point tracks anew.
/// Structure is dropped with the solution, since its tracks are gone.
Status LimitPointMatches(int max_per_pair, Scene* scene);

}  // namespace lowlap
