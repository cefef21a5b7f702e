#include "lowlap/averaging/strategies/internal/direction_parts.h"

#include <algorithm>

#include "lowlap/averaging/strategies/internal/direction_merging.h"
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
  TranslationSolution solution;
  solution.component.assign(problem.views.size(), -1);
  solution.center_in_world.assign(problem.views.size(), Vec3::Zero());
  struct Placed {
    std::vector<std::size_t> views;
    std::vector<Vec3> centers;
  };
  std::vector<Placed> placed;
  std::vector<char> is_taken(problem.views.size(), 0);
  LOWLAP_ASSIGN_OR_RETURN(const auto parts,
                          FindDirectionParts(problem, context));
  for (const DirectionPart& part : parts) {
    std::vector<std::size_t> own;
    for (std::size_t n = 0; n < part.views.size(); ++n) {
      if (!is_taken[part.views[n]]) own.push_back(n);
    }
    if (own.size() < 2) continue;
    LOWLAP_ASSIGN_OR_RETURN(const auto centers,
                            solve(part, context, &solution.num_iterations));
    Placed& component = placed.emplace_back();
    for (const std::size_t n : own) {
      is_taken[part.views[n]] = 1;
      component.views.push_back(part.views[n]);
      component.centers.push_back(centers[n]);
    }
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) {
                     return a.views.size() > b.views.size();
                   });
  for (const Placed& component : placed) {
    for (std::size_t n = 0; n < component.views.size(); ++n) {
      solution.component[component.views[n]] = solution.num_components;
      solution.center_in_world[component.views[n]] = component.centers[n];
    }
    ++solution.num_components;
  }
  return solution;
}

}  // namespace lowlap
