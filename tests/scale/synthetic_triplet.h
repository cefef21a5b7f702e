#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/scale/evidence/evidence_registry.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap::testing {

struct SyntheticTripletOptions {
  int num_points = 0;
  int num_lines = 0;     // seen by all three views
  int num_lines_ij = 0;  // seen by (i, j) alone, for coplanar pairs
  int num_lines_jk = 0;  // seen by (j, k) alone
  double noise_px = 0;
  /// Share of the features that are wrong: a point or line whose match in k is
  /// that of another depth, a line of a pair that is on no wall.
  double wrong_share = 0;
  /// Every feature has a depth of its own in either pair: there is no ratio.
  bool pure_noise = false;
  double rotation_error_deg = 0;
  double direction_error_deg = 0;
};

struct SyntheticTriplet {
  TripletView view;
  double true_log_ratio = 0;
  /// Wall of each line of view.lines_ij and lines_jk; -1: on none.
  std::vector<int> wall_ij;
  std::vector<int> wall_jk;
};

/// What three cameras in a SyntheticRoom see of it, with noise, wrong matches
/// and errors of the relative poses.
SyntheticTriplet MakeSyntheticTriplet(const SyntheticTripletOptions& options,
                                      std::uint64_t seed);

/// What the built-in kinds of these words say; all kinds without words.
inline TripletEvidence Gather(const TripletView& view,
                              const std::vector<std::string>& features = {}) {
  return GatherEvidence(*EvidenceRegistry::BuiltIn().Make(features, {}), view);
}

/// The same triplet read from the other end.
TripletView SwapEnds(const TripletView& view);

}  // namespace lowlap::testing
