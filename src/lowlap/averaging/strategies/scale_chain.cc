#include "lowlap/averaging/strategies/internal/scale_chain.h"

#include <cmath>
#include <utility>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/internal/difference_solver.h"
#include "lowlap/averaging/scales/internal/edge_groups.h"
#include "lowlap/averaging/scales/internal/edge_scales.h"
#include "lowlap/averaging/strategies/internal/placed_parts.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {

Result<TranslationSolution> ScaleChainAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  LOWLAP_RETURN_IF_ERROR(ValidateProblem(problem));
  const std::size_t num_views = problem.views.size();
  PlacedParts parts(num_views);
  const EdgeScales scales = ChainEdgeScales(problem);
  const std::vector<EdgeGroup> groups = RankedEdgeGroups(problem, scales);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, g, groups.size()));
    const EdgeGroup& group = groups[g];
    std::vector<DifferenceEdge> graph;
    std::vector<double> costs;
    for (const std::size_t e : group.edges) {
      graph.push_back({problem.edges[e].first, problem.edges[e].second});
      costs.push_back(problem.edges[e].stddev_rad);
    }
    std::vector<Vec3> centers(num_views, Vec3::Zero());
    for (const ForestStep& step :
         MinimumSpanningForest(num_views, graph, costs)) {
      const std::size_t e = group.edges[step.edge];
      const DirectionEdge& edge = problem.edges[e];
      const double length = std::exp(scales.log_length[e]);
      centers[step.to] =
          centers[step.from] + (step.from == edge.first ? length : -length) *
                                   edge.direction_in_world;
    }
    std::vector<Vec3> of_group;
    for (const std::size_t view : group.views) {
      of_group.push_back(centers[view]);
    }
    parts.Add(group.views, std::move(of_group));
  }
  return std::move(parts).MakeSolution();
}

}  // namespace lowlap
