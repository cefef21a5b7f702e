#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// A segment of the middle view matched in the first, next to one matched in
/// the last, and whether the two 3D lines truly lie on one wall.
struct CoplanarCandidate {
  FeatureIndex line_in_first = 0;  // segments of the middle view
  FeatureIndex line_in_last = 0;
  bool is_coplanar = false;
};

/// The pairs that a nearest-neighbour search proposes in the middle view: for
/// each segment matched in one neighbour, its `num_neighbors` nearest segments
/// (least distance between segments) matched in the other, both ways, without
/// repetition and without pairs of one track; sorted. A pair with a wrong match
/// is not coplanar. Empty if a pair of the triplet is missing.
std::vector<CoplanarCandidate> CoplanarCandidates(
    const SyntheticScene& synthetic, const ViewTriplet& triplet,
    int num_neighbors = 10);

struct CandidateCount {
  int total = 0;
  int wrong = 0;
  double WrongShare() const {
    return total > 0 ? static_cast<double>(wrong) / total : 0.0;
  }
};

/// Over all triplets of the scene's pairs; of more than 200 triplets, an even
/// sample of 200.
CandidateCount CountCoplanarCandidates(const SyntheticScene& synthetic,
                                       int num_neighbors = 10);

}  // namespace lowlap
