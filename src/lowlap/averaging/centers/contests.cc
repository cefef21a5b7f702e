#include "lowlap/averaging/centers/internal/contests.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "lowlap/averaging/centers/internal/least_cut.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

/// Turns are the same up to this, where the solution is bent elsewhere.
const double kSameTurnRad = RadFromDeg(6);
constexpr double kSameTurnReach = 3;

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

// Views that poses in use join to the others with hardly more evidence than
// rejected ones have across the same cut.
void AddPoseContests(const ViewGraph& graph, const EvidenceOfPairs& in_use,
                     const RejectedPoses& rejected,
                     std::vector<Contest>* contests) {
  WeakCuts cuts(graph, in_use);
  std::set<std::set<ViewId>> sides;
  for (const auto& entry : rejected) {
    const auto [side_entry, is_new] =
        sides.insert(cuts.SideOf(entry.first.first, entry.first.second));
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
