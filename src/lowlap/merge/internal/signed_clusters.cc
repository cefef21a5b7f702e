#include "lowlap/merge/internal/signed_clusters.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>

#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

// Two clusters and what speaks for joining them; of equals the first ones go
// first.
struct Candidate {
  double evidence = 0;
  std::size_t first = 0;
  std::size_t second = 0;

  friend bool operator<(const Candidate& a, const Candidate& b) {
    return std::tie(a.evidence, b.first, b.second) <
           std::tie(b.evidence, a.first, a.second);
  }
};

}  // namespace

std::vector<std::size_t> ClusterByLinks(std::size_t count,
                                        const std::vector<SignedLink>& links) {
  std::vector<std::map<std::size_t, double>> evidence(count);
  for (const SignedLink& link : links) {
    evidence[link.first][link.second] += link.evidence;
    evidence[link.second][link.first] += link.evidence;
  }
  std::priority_queue<Candidate> candidates;
  for (std::size_t a = 0; a < count; ++a) {
    for (const auto& [b, value] : evidence[a]) {
      if (a < b && value > 0) candidates.push({value, a, b});
    }
  }
  UnionFind joined(count);
  while (!candidates.empty()) {
    const Candidate best = candidates.top();
    candidates.pop();
    // What was joined since has another candidate, or none.
    const auto current = evidence[best.first].find(best.second);
    if (current == evidence[best.first].end() ||
        current->second != best.evidence) {
      continue;
    }
    const auto [kept, gone] =
        evidence[best.first].size() < evidence[best.second].size()
            ? std::tie(best.second, best.first)
            : std::tie(best.first, best.second);
    joined.Union(kept, gone);
    for (const auto& [other, value] : evidence[gone]) {
      evidence[other].erase(gone);
      if (other == kept) continue;
      const double sum = evidence[kept][other] += value;
      evidence[other][kept] = sum;
      if (sum > 0) {
        candidates.push({sum, std::min(kept, other), std::max(kept, other)});
      }
    }
    evidence[gone].clear();
  }
  return joined.Labels();
}

}  // namespace lowlap
