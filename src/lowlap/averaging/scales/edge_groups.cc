#include "lowlap/averaging/scales/internal/edge_groups.h"

#include <algorithm>

namespace lowlap {

std::vector<EdgeGroup> RankedEdgeGroups(const TranslationProblem& problem,
                                        const EdgeScales& scales) {
  std::vector<EdgeGroup> groups;
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const std::size_t label = scales.component[e];
    if (label >= groups.size()) groups.resize(label + 1);
    groups[label].edges.push_back(e);
    groups[label].views.push_back(problem.edges[e].first);
    groups[label].views.push_back(problem.edges[e].second);
  }
  for (EdgeGroup& group : groups) {
    std::sort(group.views.begin(), group.views.end());
    group.views.erase(std::unique(group.views.begin(), group.views.end()),
                      group.views.end());
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const EdgeGroup& a, const EdgeGroup& b) {
                     return a.views.size() != b.views.size()
                                ? a.views.size() > b.views.size()
                                : a.edges.size() > b.edges.size();
                   });
  return groups;
}

}  // namespace lowlap
