#pragma once

#include <cstddef>
#include <vector>

namespace lowlap {

/// That a neighbouring candidate match speaks for one, and how much.
struct Support {
  std::size_t candidate;
  double weight;
};

/// The scores of candidate matches after `iterations` rounds of relaxation.
/// supports[c] has one list per neighbour of candidate c; its support is the
/// mean over them of
///   max over the list of  weight score(candidate),
/// and its new score support / (support + half_support), in [0, 1). Candidates
/// without neighbours end at zero.
std::vector<double> RelaxScores(
    std::vector<double> scores,
    const std::vector<std::vector<std::vector<Support>>>& supports,
    double half_support, int iterations);

}  // namespace lowlap
