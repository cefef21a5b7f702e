#include "lowlap/averaging/strategies/internal/direction_parts.h"

#include <algorithm>
#include <utility>

#include "lowlap/averaging/strategies/internal/direction_merging.h"
#include "lowlap/averaging/strategies/internal/placed_parts.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {

DirectionPart MakePart(const std::vector<DirectionEdge>& edges,
                       const std::vector<std::size_t>& members) {
  DirectionPart part;
  for (const std::size_t e : members) {
    part.views.push_back(edges[e].first);
    part.views.push_back(edges[e].second);
  }
  std::sort(part.views.begin(), part.views.end());
  part.views.erase(std::unique(part.views.begin(), part.views.end()),
                   part.views.end());
  const auto index_of = [&](std::size_t view) {
    return static_cast<std::size_t>(
        std::lower_bound(part.views.begin(), part.views.end(), view) -
        part.views.begin());
  };
  for (const std::size_t e : members) {
    DirectionEdge edge = edges[e];
    edge.first = index_of(edge.first);
    edge.second = index_of(edge.second);
    part.edges.push_back(edge);
  }
  return part;
}

Result<std::vector<DirectionPart>> FindDirectionParts(
    const TranslationProblem& problem, const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(const std::vector<std::size_t>& labels,
                          LabelRigidEdges(problem, context));
  std::vector<std::vector<std::size_t>> members;
  for (std::size_t e = 0; e < labels.size(); ++e) {
    if (labels[e] >= members.size()) members.resize(labels[e] + 1);
    members[labels[e]].push_back(e);
  }
  std::vector<DirectionPart> parts;
  for (const std::vector<std::size_t>& edges : members) {
    if (edges.size() < 3) continue;
    DirectionPart part = MakePart(problem.edges, edges);
    if (part.views.size() >= 3) parts.push_back(std::move(part));
  }
  // By what does not depend on the order of the edges.
  std::sort(parts.begin(), parts.end(),
            [](const DirectionPart& a, const DirectionPart& b) {
              if (a.views.size() != b.views.size()) {
                return a.views.size() > b.views.size();
              }
              return a.views < b.views;
            });
  return parts;
}

Result<TranslationSolution> SolveDirectionParts(
    const TranslationProblem& problem, const RunContext& context,
    const PartSolver& solve) {
  LOWLAP_RETURN_IF_ERROR(ValidateProblem(problem));
  PlacedParts placed(problem.views.size());
  int num_iterations = 0;
  LOWLAP_ASSIGN_OR_RETURN(const auto parts,
                          FindDirectionParts(problem, context));
  for (const DirectionPart& part : parts) {
    std::vector<std::size_t> own;
    for (std::size_t n = 0; n < part.views.size(); ++n) {
      if (!placed.Has(part.views[n])) own.push_back(n);
    }
    if (own.size() < 2) continue;
    LOWLAP_ASSIGN_OR_RETURN(const auto centers,
                            solve(part, context, &num_iterations));
    std::vector<std::size_t> own_views;
    std::vector<Vec3> own_centers;
    for (const std::size_t n : own) {
      own_views.push_back(part.views[n]);
      own_centers.push_back(centers[n]);
    }
    placed.Add(std::move(own_views), std::move(own_centers));
  }
  TranslationSolution solution = std::move(placed).MakeSolution();
  solution.num_iterations = num_iterations;
  return solution;
}

}  // namespace lowlap
