#include "lowlap/averaging/internal/contests.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr int kMaxWays = 8;

/// Maximum flow by shortest augmenting paths (Edmonds and Karp 1972); what the
/// source still reaches is its side of the least cut.
class LeastCut {
 public:
  explicit LeastCut(const EvidenceOfPairs& in_use) {
    for (const auto& [pair, evidence] : in_use) {
      residual_[pair.first][pair.second] = evidence;
      residual_[pair.second][pair.first] = evidence;
    }
  }

  /// Empty if nothing joins the two, or more than kMaxWays ways do.
  std::set<ViewId> SideOf(ViewId from, ViewId to) const {
    Residual residual = residual_;
    for (int way = 0; way <= kMaxWays; ++way) {
      std::map<ViewId, ViewId> previous = {{from, from}};
      std::vector<ViewId> open = {from};
      for (std::size_t n = 0; n < open.size() && previous.count(to) == 0; ++n) {
        for (const auto& [next, capacity] : residual[open[n]]) {
          if (capacity > 0 && previous.emplace(next, open[n]).second) {
            open.push_back(next);
          }
        }
      }
      if (previous.count(to) == 0) {
        return way == 0 ? std::set<ViewId>()
                        : std::set<ViewId>(open.begin(), open.end());
      }
      double flow = std::numeric_limits<double>::infinity();
      for (ViewId v = to; v != from; v = previous.at(v)) {
        flow = std::min(flow, residual[previous.at(v)][v]);
      }
      for (ViewId v = to; v != from; v = previous.at(v)) {
        residual[previous.at(v)][v] -= flow;
        residual[v][previous.at(v)] += flow;
      }
    }
    return {};
  }

 private:
  using Residual = std::map<ViewId, std::map<ViewId, double>>;
  Residual residual_;
};

double Across(const EvidenceOfPairs& evidence, const std::set<ViewId>& side,
              std::vector<ViewPair>* pairs) {
  double sum = 0;
  for (const auto& [pair, value] : evidence) {
    if (side.count(pair.first) == side.count(pair.second)) continue;
    pairs->push_back(pair);
    sum += value;
  }
  return sum;
}

// The smaller side of the component that `side` is a part of.
std::vector<ViewId> SmallerSide(const ViewGraph& graph,
                                const std::set<ViewId>& side) {
  for (const std::vector<ViewId>& component : ConnectedComponents(graph)) {
    if (!std::binary_search(component.begin(), component.end(),
                            *side.begin())) {
      continue;
    }
    std::vector<ViewId> other;
    std::set_difference(component.begin(), component.end(), side.begin(),
                        side.end(), std::back_inserter(other));
    if (other.size() < side.size()) return other;
  }
  return {side.begin(), side.end()};
}

}  // namespace

std::vector<Contest> FindContests(const EvidenceOfPairs& in_use,
                                  const EvidenceOfPairs& rejected) {
  const LeastCut cuts(in_use);
  std::vector<ViewPair> pairs;
  for (const auto& entry : in_use) pairs.push_back(entry.first);
  const ViewGraph graph(std::move(pairs));
  std::vector<Contest> contests;
  std::set<std::vector<ViewPair>> seen;
  for (const auto& entry : rejected) {
    const std::set<ViewId> side =
        cuts.SideOf(entry.first.first, entry.first.second);
    if (side.empty()) continue;
    Contest contest;
    const double for_it = Across(in_use, side, &contest.links);
    const double against = Across(rejected, side, &contest.contradictions);
    if (2 * against <= for_it || !seen.insert(contest.links).second) continue;
    contest.views = SmallerSide(graph, side);
    contests.push_back(std::move(contest));
  }
  return contests;
}

std::vector<Contest> FindScaleContests(
    const EvidenceOfPairs& in_use, const std::map<ViewTriplet, double>& ratios,
    const EvidenceOfPairs& rejected) {
  std::vector<Contest> contests;
  if (rejected.empty()) return contests;
  std::vector<ViewPair> pairs;
  for (const auto& entry : in_use) pairs.push_back(entry.first);
  const ViewGraph graph(std::move(pairs));
  for (const ViewId joint : ArticulationViews(graph)) {
    std::vector<std::vector<ViewId>> parts =
        ConnectedComponents(graph.WithoutViews({joint}));
    parts.erase(std::remove_if(parts.begin(), parts.end(),
                               [&](const std::vector<ViewId>& part) {
                                 return std::none_of(
                                     part.begin(), part.end(), [&](ViewId v) {
                                       return graph.FindPair(joint, v);
                                     });
                               }),
                parts.end());
    for (std::size_t n = 1; n < parts.size(); ++n) {
      const std::set<ViewId> side(parts[n].begin(), parts[n].end());
      double for_it = 0;
      for (const auto& [views, evidence] : ratios) {
        if (views.middle == joint &&
            side.count(views.first) != side.count(views.last)) {
          for_it = std::max(for_it, evidence);
        }
      }
      EvidenceOfPairs past_joint;
      for (const auto& entry : rejected) {
        const ViewPair& pair = entry.first;
        if (pair.first != joint && pair.second != joint) {
          past_joint.insert(entry);
        }
      }
      Contest contest;
      const double against = Across(past_joint, side, &contest.contradictions);
      if (for_it == 0 || 2 * against <= for_it) continue;
      Across(in_use, side, &contest.links);
      contest.views = parts[n];
      contests.push_back(std::move(contest));
    }
  }
  return contests;
}

}  // namespace lowlap
