#pragma once

#include <map>
#include <set>
#include <vector>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// The sets of point features that the inlier matches of the pairs of `views`
/// join, without those of `excluded` pairs, numbered from 0. A set with two
/// features of one view more than 10 px apart holds a wrong match, nobody knows
/// which, and is left out; of closer ones the first stands for both. This is
/// the rule of the program of Pan et al., ECCV 2024; scene.point_tracks keep
/// such sets, cut apart.
///
/// If no pair at all has matches, those of scene.point_tracks.
std::map<PointTrackId, Track> MatchedTracks(const Scene& scene,
                                            const std::vector<ViewId>& views,
                                            const std::set<ViewPair>& excluded);

}  // namespace lowlap
