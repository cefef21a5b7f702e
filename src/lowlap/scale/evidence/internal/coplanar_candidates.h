#pragma once

#include <vector>

#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// A hypothesis that line `first` (an index into the lines matched in (i, j))
/// and line `last` (an index into those of (j, k)) lie in one plane.
struct CoplanarPairCandidate {
  int first = 0;
  int last = 0;
  double distance_px = 0;  // least distance of the two segments in view j
  /// How far the crossing of the two lines in view j is from the farther of
  /// the two segments: near 0 where they meet or cross.
  double crossing_px = 0;
  RatioCandidate ratio;  // always kValid
};

struct CoplanarPairCandidates {
  std::vector<CoplanarPairCandidate> pairs;  // sorted by (first, last)
  /// Pairs that came near enough but ask for a negative depth.
  int num_rejected_negative = 0;
};

/// For every line of either list its `num_neighbors` nearest usable lines of
/// the other list, by the least distance between the segments in the middle
/// view (Salaün et al. 2017, section 5, there with N = 10). The union of both
/// directions, so that it does not matter which end of the triplet is called i.
///
/// A pair takes one of the N places only if it can say something: two segments
/// of one index, pairs without a crossing or with a hopeless one
/// (kMaxPlaneLogRatioStddev) and pairs with a negative depth are passed
/// over. Exact ones are computed for few: segments are looked at in the order
/// of the gaps between the discs around them (DiscIndex).
CoplanarPairCandidates FindCoplanarCandidates(
    const TripletGeometry& geometry, const std::vector<MatchedLine>& lines_ij,
    const std::vector<MatchedLine>& lines_jk, int num_neighbors);

/// Least distance between two segments of one view (0 if they cross), in
/// normalised coordinates.
double SegmentDistance(const NormalizedSegment& a, const NormalizedSegment& b);

}  // namespace lowlap
