#include "lowlap/averaging/reliability/internal/look_alikes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "lowlap/averaging/centers/internal/evidence.h"
#include "lowlap/averaging/reliability/internal/agreeing_poses.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

constexpr double kMinShareOfAlike = 0.2;
constexpr double kShareOfRate = 0.75;
constexpr double kMaxLog10Nfa = -2;
// Of relative poses that contradict the solution, against those in use.
constexpr double kMinShareOfContested = 0.25;
constexpr double kMaxLog10NfaOfContested = -1;
// Regions of pairs of the same views tell the same thing several times: many
// have to be bare, against the chance of it.
constexpr double kMinBareToChance = 2;
// What hides a part of one view leaves regions of all its pairs bare.
constexpr double kChanceOfBareUnlessKnown = 2 * kChanceOfBare;

// That should share enough to be told apart.
std::vector<ViewPair> SharingPairs(const ExpectedOverlaps& overlaps) {
  std::vector<ViewPair> pairs;
  for (const auto& [views, overlap] : overlaps) {
    if (overlap.share >= kMinShareOfAlike) pairs.push_back(views);
  }
  return pairs;
}

// The part of what is expected that a quarter of the relative poses exceed.
double UsualRate(const std::vector<ViewPair>& pairs,
                 const ExpectedOverlaps& overlaps, const ViewGraph& agreeing) {
  std::vector<double> found;
  for (const ViewPair& views : pairs) {
    if (agreeing.FindPair(views.first, views.second)) {
      found.push_back(overlaps.at(views).found);
    }
  }
  if (found.empty()) return 0;
  const auto quarter = found.begin() + static_cast<std::ptrdiff_t>(
                                           found.size() - 1 - found.size() / 4);
  std::nth_element(found.begin(), quarter, found.end());
  return *quarter;
}

// What two groups should both see, and the evidence of the relative poses
// between them.
struct Common {
  OverlapRegions regions;
  double in_use = 0, rejected = 0;

  bool IsContested() const { return rejected > kMinShareOfContested * in_use; }
  Common& operator+=(const Common& other) {
    regions += other.regions;
    in_use += other.in_use;
    rejected += other.rejected;
    return *this;
  }
};

// What is known before groups grow.
struct Findings {
  EvidenceOfPairs in_use, rejected;
  std::vector<ViewPair> sharing;
  std::vector<OverlapRegions> regions;  // of the sharing pairs
};

// Views that grow together along links.
class Groups {
 public:
  Groups(const Findings& findings, double chance_of_bare)
      : log10_num_pairs_(
            std::log10(static_cast<double>(findings.sharing.size()))),
        chance_of_bare_(chance_of_bare) {
    for (const auto& entry : findings.in_use) {
      for (const ViewId view : {entry.first.first, entry.first.second}) {
        group_of_.emplace(view, view);
      }
    }
    const auto add = [&](const ViewPair& views, const Common& common) {
      Add(views.first, views.second, common);
    };
    for (std::size_t n = 0; n < findings.sharing.size(); ++n) {
      add(findings.sharing[n], {findings.regions[n]});
    }
    for (const auto& [views, evidence] : findings.in_use) {
      add(views, {{}, evidence});
    }
    for (const auto& [views, evidence] : findings.rejected) {
      add(views, {{}, 0, evidence});
    }
  }

  // The strongest link of groups that are not different, again and again.
  // `links`: the strongest first.
  void Grow(const std::vector<ViewPair>& links) {
    std::vector<ViewPair> passed_over;
    const auto next = [&] {
      return std::find_if(
          passed_over.begin(), passed_over.end(),
          [&](const ViewPair& v) { return !AreJoint(v) && !AreApart(v); });
    };
    for (const ViewPair& link : links) {
      if (AreJoint(link)) continue;
      if (AreApart(link)) {
        passed_over.push_back(link);
        continue;
      }
      Join(link);
      // With all their views, groups may be different no longer.
      while (next() != passed_over.end()) Join(*next());
    }
  }

  // In groups that are different.
  bool AreApart(const ViewPair& views) const {
    const auto first = group_of_.find(views.first);
    const auto second = group_of_.find(views.second);
    return first != group_of_.end() && second != group_of_.end() &&
           AreDifferent(first->second, second->second);
  }

  // All but the largest group; all if that has no majority.
  std::vector<ViewId> ViewsOfOthers() const {
    std::map<ViewId, std::size_t> sizes;
    for (const auto& entry : group_of_) ++sizes[entry.second];
    ViewId largest = kInvalidId;
    for (const auto& [group, size] : sizes) {
      if (2 * size > group_of_.size()) largest = group;
    }
    std::vector<ViewId> views;
    for (const auto& [view, group] : group_of_) {
      if (group != largest) views.push_back(view);
    }
    return views;
  }

 private:
  struct Judged {
    Common common;
    bool is_different = false;
  };

  bool AreJoint(const ViewPair& views) const {
    return group_of_.at(views.first) == group_of_.at(views.second);
  }

  bool AreDifferent(ViewId a, ViewId b) const {
    const auto of_a = common_.find(a);
    if (of_a == common_.end()) return false;
    const auto found = of_a->second.find(b);
    return found != of_a->second.end() && found->second.is_different;
  }

  bool AreDifferent(const Common& common) const {
    const bool is_contested = common.IsContested();
    const double chance = is_contested ? kChanceOfBare : chance_of_bare_;
    const OverlapRegions& all = common.regions;
    return all.num_bare >= kMinBareToChance * chance * all.num &&
           log10_num_pairs_ + Log10ChanceOfBare(all, chance) <=
               (is_contested ? kMaxLog10NfaOfContested : kMaxLog10Nfa);
  }

  void Add(ViewId a, ViewId b, const Common& more) {
    Judged& judged = common_[a][b];
    judged.common += more;
    judged.is_different = AreDifferent(judged.common);
    common_[b][a] = judged;
  }

  // The group of the second view becomes a part of that of the first.
  void Join(const ViewPair& link) {
    const ViewId first = group_of_.at(link.first);
    const ViewId second = group_of_.at(link.second);
    for (auto& entry : group_of_) {
      if (entry.second == second) entry.second = first;
    }
    for (const auto& [other, judged] : common_[second]) {
      common_[other].erase(second);
      if (other != first) Add(first, other, judged.common);
    }
    common_.erase(second);
  }

  std::map<ViewId, ViewId> group_of_;  // named by one of its views
  // Of two groups, by either.
  std::map<ViewId, std::map<ViewId, Judged>> common_;
  double log10_num_pairs_;
  double chance_of_bare_;
};

double EvidenceOf(const RelativePose& pose) {
  return EvidenceOfNfa(pose.weakness ? 0 : pose.log10_nfa);
}

// Of the relative poses that contradict the solution.
EvidenceOfPairs RejectedEvidence(const Scene& scene,
                                 const PoseSummary& summary) {
  EvidenceOfPairs rejected;
  for (const auto* edges : {&summary.outlier_edges, &summary.kept_outliers}) {
    for (const OutlierEdge& edge : *edges) {
      if (!edge.IsFalse() || edge.reason == OutlierReason::kLookAlike) continue;
      rejected[edge.views] = EvidenceOf(scene.relative_poses.at(edge.views));
    }
  }
  return rejected;
}

// The strongest first.
std::vector<ViewPair> ByEvidence(const EvidenceOfPairs& evidence) {
  std::vector<ViewPair> sorted;
  sorted.reserve(evidence.size());
  for (const auto& entry : evidence) sorted.push_back(entry.first);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const ViewPair& a, const ViewPair& b) {
                     return evidence.at(a) > evidence.at(b);
                   });
  return sorted;
}

// What the findings tell where each region is bare by chance.
LookAlikes TellApart(const Findings& findings, double chance_of_bare) {
  Groups groups(findings, chance_of_bare);
  groups.Grow(ByEvidence(findings.in_use));
  LookAlikes found;
  for (const ViewPair& views : findings.sharing) {
    if (groups.AreApart(views)) found.different.push_back(views);
  }
  for (const auto& entry : findings.in_use) {
    if (groups.AreApart(entry.first)) found.false_poses.push_back(entry.first);
  }
  if (!found.false_poses.empty()) found.doubtful = groups.ViewsOfOthers();
  return found;
}

}  // namespace

Result<LookAlikes> FindLookAlikes(const Scene& scene,
                                  const PoseSummary& summary,
                                  const ExpectedOverlaps& overlaps,
                                  const RunContext& context) {
  Findings findings;
  findings.sharing = SharingPairs(overlaps);
  const std::vector<ViewPair>& sharing = findings.sharing;
  if (sharing.empty()) return LookAlikes();
  const ViewGraph agreeing = AgreeingPoses(scene, summary);
  for (const ViewPair& views : agreeing.pairs()) {
    findings.in_use[views] = EvidenceOf(scene.relative_poses.at(views));
  }
  findings.rejected = RejectedEvidence(scene, summary);
  const double min_rate = kShareOfRate * UsualRate(sharing, overlaps, agreeing);
  const OverlapPredictor predictor(scene);
  findings.regions.resize(sharing.size());
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, "bare regions", sharing.size(), [&](std::size_t n) {
        findings.regions[n] =
            predictor.RegionsOf(sharing[n].first, sharing[n].second, min_rate);
      }));
  LookAlikes found;
  const bool are_known = summary.look_alikes != nullptr &&
                         !summary.look_alikes->false_poses.empty();
  if (!are_known) {
    found = TellApart(findings, kChanceOfBareUnlessKnown);
    if (found.false_poses.empty()) return found;
  }
  LookAlikes more = TellApart(findings, kChanceOfBare);
  return more.false_poses.empty() ? found : more;
}

}  // namespace lowlap
