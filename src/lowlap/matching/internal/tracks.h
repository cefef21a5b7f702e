#pragma once

#include <map>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/matching/match_options.h"
#include "lowlap/scene/scene.h"
#include "lowlap/scene/tracks.h"

namespace lowlap {

/// Point tracks from the point inliers of all relative poses, numbered from 0
/// in the order of their first observation; at least two views each.
///
/// Matches are joined one at a time, those that close a triangle over three
/// views first, then by the meaningfulness of their relative pose. A match
/// that would bring two features of one view together is left out: a wrong
/// match then costs itself and not the tracks it would have tied together.
std::map<PointTrackId, Track> BuildPointTracks(const Scene& scene);

/// Line tracks from the line inliers, in the same way; segments of one view
/// may share a track if they are collinear, as pieces of a broken edge are.
std::map<LineTrackId, Track> BuildLineTracks(const Scene& scene,
                                             const LineTrackOptions& options);

}  // namespace lowlap
