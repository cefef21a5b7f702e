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

// Views that poses in use join to the others with hardly more evidence than
// rejected ones have across the same cut.
void AddPoseContests(const ViewGraph& graph, const EvidenceOfPairs& in_use,
                     const EvidenceOfPairs& rejected,
                     std::vector<Contest>* contests) {
  const LeastCut cuts(in_use);
  for (const auto& entry : rejected) {
    const std::set<ViewId> side =
        cuts.SideOf(entry.first.first, entry.first.second);
    if (side.empty()) continue;
    Contest contest;
    const double for_it = Across(in_use, side, &contest.links);
    const double against = Across(rejected, side, &contest.contradictions);
    if (2 * against <= for_it) continue;
    contest.views = SmallerSide(graph, side);
    contests->push_back(std::move(contest));
  }
}

// What falls off the largest part of the component of `joint` without it.
std::vector<std::vector<ViewId>> PartsAt(const ViewGraph& graph, ViewId joint) {
  std::vector<std::vector<ViewId>> parts;
  for (std::vector<ViewId>& part :
       ConnectedComponents(graph.WithoutViews({joint}))) {
    const bool meets_joint = std::any_of(
        part.begin(), part.end(),
        [&](ViewId view) { return graph.FindPair(joint, view).has_value(); });
    if (meets_joint) parts.push_back(std::move(part));
  }
  if (!parts.empty()) parts.erase(parts.begin());
  return parts;
}

// The same for the scale across one camera.
void AddScaleContests(const ViewGraph& graph, const EvidenceOfPairs& in_use,
                      const EvidenceOfRatios& ratios,
                      const EvidenceOfPairs& rejected,
                      std::vector<Contest>* contests) {
  for (const ViewId joint : ArticulationViews(graph)) {
    EvidenceOfPairs past_joint;
    for (const auto& entry : rejected) {
      const ViewPair& pair = entry.first;
      if (pair.first != joint && pair.second != joint) past_joint.insert(entry);
    }
    if (past_joint.empty()) continue;
    for (std::vector<ViewId>& part : PartsAt(graph, joint)) {
      const std::set<ViewId> side(part.begin(), part.end());
      double for_it = 0;
      for (const auto& [views, evidence] : ratios) {
        if (views.middle == joint &&
            side.count(views.first) != side.count(views.last)) {
          for_it = std::max(for_it, evidence);
        }
      }
      Contest contest;
      const double against = Across(past_joint, side, &contest.contradictions);
      if (for_it == 0 || 2 * against <= for_it) continue;
      Across(in_use, side, &contest.links);
      contest.views = std::move(part);
      contests->push_back(std::move(contest));
    }
  }
}

template <class T>
void Unite(const std::vector<T>& more, std::vector<T>* sorted) {
  std::vector<T> all;
  std::set_union(sorted->begin(), sorted->end(), more.begin(), more.end(),
                 std::back_inserter(all));
  *sorted = std::move(all);
}

}  // namespace

std::vector<Contest> FindContests(const EvidenceOfPairs& in_use,
                                  const EvidenceOfRatios& ratios,
                                  const EvidenceOfPairs& rejected) {
  std::vector<ViewPair> pairs;
  for (const auto& entry : in_use) pairs.push_back(entry.first);
  const ViewGraph graph(std::move(pairs));
  std::vector<Contest> cuts;
  AddPoseContests(graph, in_use, rejected, &cuts);
  AddScaleContests(graph, in_use, ratios, rejected, &cuts);
  std::map<std::vector<ViewPair>, Contest> by_cause;
  for (const Contest& cut : cuts) {
    Contest& contest = by_cause[cut.contradictions];
    contest.contradictions = cut.contradictions;
    Unite(cut.links, &contest.links);
    Unite(cut.views, &contest.views);
  }
  std::vector<Contest> contests;
  for (auto& entry : by_cause) contests.push_back(std::move(entry.second));
  return contests;
}

}  // namespace lowlap
