#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/scales/internal/edge_scales.h"
#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// Edges whose relative lengths are known, and the views they join.
struct EdgeGroup {
  std::vector<std::size_t> edges;
  std::vector<std::size_t> views;  // sorted
};

/// The components of the ratio graph, most views first (ties: more edges, then
/// the first edge), so that the first is the one to build on.
std::vector<EdgeGroup> RankedEdgeGroups(const TranslationProblem& problem,
                                        const EdgeScales& scales);

}  // namespace lowlap
