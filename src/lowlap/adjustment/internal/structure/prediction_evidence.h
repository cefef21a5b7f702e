#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What the structure of a solved scene says for pairs and triplets of views,
/// whatever their own relative poses and ratios say: log10 NFA that it predicts
/// by chance where one of the views sees what the others see. Those without a
/// pose for every view are left out.
struct PredictionEvidence {
  std::map<ViewPair, double> pairs;
  std::map<ViewTriplet, double> triplets;
  /// The pairs that share more than six tracks, of which the structure predicts
  /// less than half to within 16 px in either view: something is wrong with the
  /// place of one of the two.
  std::vector<ViewPair> contradicted;
};

/// Of a view v of a pair or triplet a datum is every track with candidates in
/// all its views and in three poses, none of which repeats in its photograph
/// (ViewFeatures::repeated_points): copies have a structure of their own. Its
/// landmark is refined without v, and the error is that of v's worst candidate
/// (px); infinite where there is no landmark, or where it does not rest on the
/// other views, and two poses, then. With k of n errors at most e,
///   NFA = 2 T C(n, k) C(k, 6) (2 D e / A)^(k - 6),
/// the less for the two ends of the pair or triplet, T the steps of
/// AContrarioLadder: six tracks, of two measurements each beyond what a
/// landmark takes, fix the eleven unknowns of three views.
///
/// 0 where chance explains all, where most tracks are not within e (an
/// adjustment from a bad start may still come to satisfy some), or where six
/// tracks or fewer are shared. Cost: two refinements of every shared track. The
/// scene must be valid (ValidateScene).
PredictionEvidence FindPredictionEvidence(
    const Scene& scene, const std::vector<ViewPair>& pairs,
    const std::vector<ViewTriplet>& triplets);

}  // namespace lowlap
