#include "lowlap/averaging/centers/internal/contests.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr int kMaxWays = 8;
/// Turns are the same up to this, where the solution is bent elsewhere.
const double kSameTurnRad = RadFromDeg(6);
constexpr double kSameTurnReach = 3;

/// Maximum flow by shortest augmenting paths (Edmonds and Karp 1972); what the
/// source still reaches is its side of the least cut. Every search leaves the
/// one residual graph as it was.
class LeastCut {
 public:
  LeastCut(const ViewGraph& graph, const EvidenceOfPairs& in_use)
      : views_(graph.views()), arcs_(views_.size()), into_(views_.size()) {
    // Pairs are sorted, and so are the arcs of a view by where they go.
    for (const auto& [pair, evidence] : in_use) {
      const std::size_t first = *IndexOf(pair.first);
      const std::size_t second = *IndexOf(pair.second);
      arcs_[first].push_back(
          {second, arcs_[second].size(), evidence, evidence});
      arcs_[second].push_back(
          {first, arcs_[first].size() - 1, evidence, evidence});
    }
  }

  /// Empty if nothing joins the two, or `max_searches` do not fill all ways.
  std::set<ViewId> SideOf(ViewId from_view, ViewId to_view, int max_searches) {
    const std::optional<std::size_t> from = IndexOf(from_view);
    const std::optional<std::size_t> to = IndexOf(to_view);
    if (!from || !to) return {};
    std::set<ViewId> side;
    for (int way = 0; way < max_searches; ++way) {
      const std::vector<std::size_t> reached = Reach(*from, *to);
      if (into_[*to] == nullptr) {
        if (way == 0) break;
        for (const std::size_t n : reached) side.insert(views_[n]);
        break;
      }
      FillWay(*to);
    }
    for (Arc* arc : used_) arc->residual = arc->evidence;
    used_.clear();
    return side;
  }

 private:
  struct Arc {
    std::size_t to;
    std::size_t back;  // index of the reverse among the arcs of `to`
    double evidence;
    double residual;
  };

  std::optional<std::size_t> IndexOf(ViewId view) const {
    const auto found = std::lower_bound(views_.begin(), views_.end(), view);
    if (found == views_.end() || *found != view) return std::nullopt;
    return static_cast<std::size_t>(found - views_.begin());
  }

  Arc* Reverse(const Arc& arc) { return &arcs_[arc.to][arc.back]; }

  // The views that `from` reaches until `to` is among them, and the arc into
  // each but the first.
  std::vector<std::size_t> Reach(std::size_t from, std::size_t to) {
    std::fill(into_.begin(), into_.end(), nullptr);
    std::vector<std::size_t> reached = {from};
    for (std::size_t n = 0; n < reached.size() && into_[to] == nullptr; ++n) {
      for (Arc& arc : arcs_[reached[n]]) {
        if (!(arc.residual > 0) || arc.to == from || into_[arc.to] != nullptr) {
          continue;
        }
        into_[arc.to] = &arc;
        reached.push_back(arc.to);
      }
    }
    return reached;
  }

  // As much as the way that Reach found to `to` still takes.
  void FillWay(std::size_t to) {
    std::vector<Arc*> way;
    double flow = std::numeric_limits<double>::infinity();
    for (Arc* arc = into_[to]; arc != nullptr; arc = into_[Reverse(*arc)->to]) {
      way.push_back(arc);
      flow = std::min(flow, arc->residual);
    }
    for (Arc* arc : way) {
      Arc* const reverse = Reverse(*arc);
      arc->residual -= flow;
      reverse->residual += flow;
      used_.insert(used_.end(), {arc, reverse});
    }
  }

  const std::vector<ViewId>& views_;
  std::vector<std::vector<Arc>> arcs_;
  std::vector<Arc*> into_;
  std::vector<Arc*> used_;
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

bool AgreeOnTurn(const RejectedPose& a, const RejectedPose& b) {
  return RotationAngleBetween(a.turn, b.turn) <=
         std::max(kSameTurnRad,
                  kSameTurnReach * std::hypot(a.stddev_rad, b.stddev_rad));
}

// The most evidence of rejected pairs across that may be right together.
double MostAcross(const RejectedPoses& rejected, const std::set<ViewId>& side,
                  std::vector<ViewPair>* pairs) {
  RejectedPoses across;
  for (const auto& [pair, pose] : rejected) {
    const bool is_of_second = side.count(pair.second) > 0;
    if (is_of_second == (side.count(pair.first) > 0)) continue;
    RejectedPose& oriented = across[pair] = pose;
    if (is_of_second) oriented.turn.transposeInPlace();
  }
  double most = 0;
  for (const auto& one : across) {
    std::vector<ViewPair> agreeing;
    double sum = 0;
    for (const auto& [pair, pose] : across) {
      if (!AgreeOnTurn(one.second, pose)) continue;
      agreeing.push_back(pair);
      sum += pose.evidence;
    }
    if (sum <= most) continue;
    most = sum;
    *pairs = std::move(agreeing);
  }
  return most;
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
                     const RejectedPoses& rejected,
                     std::vector<Contest>* contests) {
  EvidenceOfPairs one_each;
  for (const auto& entry : in_use) one_each[entry.first] = 1;
  LeastCut ways(graph, one_each), cuts(graph, in_use);
  std::set<std::set<ViewId>> sides;
  for (const auto& entry : rejected) {
    const auto [first, second] = entry.first;
    // Every search finds one more way where each pair takes one.
    if (ways.SideOf(first, second, kMaxWays + 1).empty()) continue;
    // Evidence may flow over one link from many ways.
    const auto [side_entry, is_new] = sides.insert(
        cuts.SideOf(first, second, std::numeric_limits<int>::max()));
    const std::set<ViewId>& side = *side_entry;
    // Many pairs have the same cut.
    if (side.empty() || !is_new) continue;
    Contest contest;
    contest.evidence = Across(in_use, side, &contest.links);
    const double against = MostAcross(rejected, side, &contest.contradictions);
    if (2 * against <= contest.evidence) continue;
    contest.weakest_links = contest.links;
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
                      const RejectedPoses& rejected,
                      std::vector<Contest>* contests) {
  for (const ViewId joint : ArticulationViews(graph)) {
    RejectedPoses past_joint;
    for (const auto& entry : rejected) {
      const ViewPair& pair = entry.first;
      if (pair.first != joint && pair.second != joint) past_joint.insert(entry);
    }
    if (past_joint.empty()) continue;
    for (std::vector<ViewId>& part : PartsAt(graph, joint)) {
      const std::set<ViewId> side(part.begin(), part.end());
      Contest contest;
      for (const auto& [views, evidence] : ratios) {
        if (views.middle == joint &&
            side.count(views.first) != side.count(views.last)) {
          contest.evidence = std::max(contest.evidence, evidence);
        }
      }
      const double against =
          MostAcross(past_joint, side, &contest.contradictions);
      if (contest.evidence == 0 || 2 * against <= contest.evidence) continue;
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
                                  const RejectedPoses& rejected) {
  std::vector<ViewPair> pairs;
  for (const auto& entry : in_use) pairs.push_back(entry.first);
  const ViewGraph graph(std::move(pairs));
  std::vector<Contest> cuts;
  AddPoseContests(graph, in_use, rejected, &cuts);
  AddScaleContests(graph, in_use, ratios, rejected, &cuts);
  std::stable_sort(cuts.begin(), cuts.end(), [](const auto& a, const auto& b) {
    return a.evidence < b.evidence;
  });
  std::map<std::vector<ViewPair>, Contest> by_cause;
  for (const Contest& cut : cuts) {
    const auto [entry, is_new] = by_cause.emplace(cut.contradictions, cut);
    Contest& contest = entry->second;
    if (!is_new) {
      Unite(cut.links, &contest.links);
      Unite(cut.views, &contest.views);
      if (contest.weakest_links.empty()) {
        contest.weakest_links = cut.weakest_links;
      }
      continue;
    }
    for (const ViewPair& pair : cut.contradictions) {
      contest.evidence_against.push_back(rejected.at(pair).evidence);
    }
  }
  std::vector<Contest> contests;
  contests.reserve(by_cause.size());
  for (auto& entry : by_cause) contests.push_back(std::move(entry.second));
  return contests;
}

}  // namespace lowlap
