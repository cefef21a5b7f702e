#pragma once

#include <map>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/synthetic/internal/pair_graph.h"
#include "lowlap/synthetic/internal/visibility.h"

namespace lowlap {

/// The images of one track, without noise, and the pairs that are matched.
template <class Image>
struct Sightings {
  std::map<ViewId, Image> images;
  std::vector<ViewPair> matches;
};

/// A track that is wrong in every match: the first view shows the feature; the
/// others, reached along the pairs of the graph, each show another one. With
/// wrong_fits_epipolar that is the feature of the view before, put at a wrong
/// depth along its ray (both ends of a segment, independently); a view where no
/// wrong depth is visible and at least 6 px (6 noise_px) away is left out.
Sightings<Vec2> WrongSightings(const SyntheticOptions& options,
                               const std::vector<Camera>& cameras,
                               const PairGraph& graph,
                               const std::vector<ViewId>& views,
                               const Vec3& point_in_world, Random* random);
Sightings<Segment2> WrongSightings(const SyntheticOptions& options,
                                   const std::vector<Camera>& cameras,
                                   const PairGraph& graph,
                                   const std::vector<ViewId>& views,
                                   const Segment3& segment_in_world,
                                   Random* random);

}  // namespace lowlap
