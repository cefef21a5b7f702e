#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lowlap/averaging/strategies/internal/triplet_programs.h"

namespace lowlap {

/// A triangle of edges with its baselines up to one common scale:
///   C_second - C_first = lambda baselines[n]  for the three edges n,
/// of mean length 1.
struct TripletMotion {
  std::array<std::size_t, 3> edges{};  // ascending
  std::array<Vec3, 3> baselines;
  bool has_ratio = false;
  /// Angle between the edge that closes the triangle and its direction.
  double closure_rad = 0;
};

/// The triplets of a problem as TripletProgramAverager defines them, in sets
/// that common edges join; the set with the most views first. Of more than
/// `max_triplets_per_edge` triplets at every one of its edges, those with a
/// ratio, then those that close best, are kept; none that joins two sets is
/// dropped.
std::vector<std::vector<TripletMotion>> FindTripletBaselines(
    const TranslationProblem& problem, const TripletProgramOptions& options);

}  // namespace lowlap
