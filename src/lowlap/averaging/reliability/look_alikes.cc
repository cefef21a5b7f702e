#include "lowlap/averaging/reliability/internal/look_alikes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
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

// What two groups should both see.
struct Common {
  OverlapRegions regions;
  bool is_different = false;
};

// Views that grow together along links.
class Groups {
 public:
  // `regions`: of `pairs`.
  Groups(const ViewGraph& links, const std::vector<ViewPair>& pairs,
         const std::vector<OverlapRegions>& regions, double chance_of_bare)
      : log10_num_pairs_(std::log10(static_cast<double>(pairs.size()))),
        chance_of_bare_(chance_of_bare) {
    for (const ViewPair& views : links.pairs()) {
      for (const ViewId view : {views.first, views.second}) {
        group_of_.emplace(view, view);
      }
    }
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      Add(pairs[n].first, pairs[n].second, regions[n]);
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
  bool AreJoint(const ViewPair& views) const {
    return group_of_.at(views.first) == group_of_.at(views.second);
  }

  bool AreDifferent(ViewId a, ViewId b) const {
    const auto of_a = common_.find(a);
    if (of_a == common_.end()) return false;
    const auto found = of_a->second.find(b);
    return found != of_a->second.end() && found->second.is_different;
  }

  void Add(ViewId a, ViewId b, const OverlapRegions& regions) {
    Common& common = common_[a][b];
    common.regions += regions;
    const OverlapRegions& all = common.regions;
    common.is_different =
        all.num_bare >= kMinBareToChance * chance_of_bare_ * all.num &&
        log10_num_pairs_ + Log10ChanceOfBare(all, chance_of_bare_) <=
            kMaxLog10Nfa;
    common_[b][a] = common;
  }

  // The group of the second view becomes a part of that of the first.
  void Join(const ViewPair& link) {
    const ViewId first = group_of_.at(link.first);
    const ViewId second = group_of_.at(link.second);
    for (auto& entry : group_of_) {
      if (entry.second == second) entry.second = first;
    }
    for (const auto& [other, common] : common_[second]) {
      common_[other].erase(second);
      if (other != first) Add(first, other, common.regions);
    }
    common_.erase(second);
  }

  std::map<ViewId, ViewId> group_of_;  // named by one of its views
  // Of two groups, by either.
  std::map<ViewId, std::map<ViewId, Common>> common_;
  double log10_num_pairs_;
  double chance_of_bare_;
};

// The strongest first.
std::vector<ViewPair> ByEvidence(const Scene& scene, const ViewGraph& links) {
  EvidenceOfPairs evidence;
  for (const ViewPair& views : links.pairs()) {
    const RelativePose& pose = scene.relative_poses.at(views);
    evidence[views] = EvidenceOfNfa(pose.weakness ? 0 : pose.log10_nfa);
  }
  std::vector<ViewPair> sorted = links.pairs();
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const ViewPair& a, const ViewPair& b) {
                     return evidence.at(a) > evidence.at(b);
                   });
  return sorted;
}

// What the regions of the sharing pairs tell, each of which is bare by chance.
LookAlikes TellApart(const Scene& scene, const ViewGraph& agreeing,
                     const std::vector<ViewPair>& sharing,
                     const std::vector<OverlapRegions>& regions,
                     double chance_of_bare) {
  Groups groups(agreeing, sharing, regions, chance_of_bare);
  groups.Grow(ByEvidence(scene, agreeing));
  const auto are_apart = [&](const ViewPair& v) { return groups.AreApart(v); };
  LookAlikes found;
  std::copy_if(sharing.begin(), sharing.end(),
               std::back_inserter(found.different), are_apart);
  std::copy_if(agreeing.pairs().begin(), agreeing.pairs().end(),
               std::back_inserter(found.false_poses), are_apart);
  if (!found.false_poses.empty()) found.doubtful = groups.ViewsOfOthers();
  return found;
}

}  // namespace

Result<LookAlikes> FindLookAlikes(const Scene& scene,
                                  const PoseSummary& summary,
                                  const ExpectedOverlaps& overlaps,
                                  const RunContext& context) {
  const std::vector<ViewPair> sharing = SharingPairs(overlaps);
  if (sharing.empty()) return LookAlikes();
  const ViewGraph agreeing = AgreeingPoses(scene, summary);
  const double min_rate = kShareOfRate * UsualRate(sharing, overlaps, agreeing);
  const OverlapPredictor predictor(scene);
  std::vector<OverlapRegions> regions(sharing.size());
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, "bare regions", sharing.size(), [&](std::size_t n) {
        regions[n] =
            predictor.RegionsOf(sharing[n].first, sharing[n].second, min_rate);
      }));
  const auto tell_apart = [&](double chance_of_bare) {
    return TellApart(scene, agreeing, sharing, regions, chance_of_bare);
  };
  LookAlikes found;
  const bool are_known = summary.look_alikes != nullptr &&
                         !summary.look_alikes->false_poses.empty();
  if (!are_known) {
    found = tell_apart(kChanceOfBareUnlessKnown);
    if (found.false_poses.empty()) return found;
  }
  LookAlikes more = tell_apart(kChanceOfBare);
  return more.false_poses.empty() ? found : more;
}

}  // namespace lowlap
