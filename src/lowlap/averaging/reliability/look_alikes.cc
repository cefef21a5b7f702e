#include "lowlap/averaging/reliability/internal/look_alikes.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <type_traits>
#include <utility>

#include "lowlap/averaging/centers/internal/evidence.h"
#include "lowlap/averaging/reliability/internal/agreeing_poses.h"

namespace lowlap {
namespace {

constexpr double kMinShareOfAlike = 0.2;
constexpr double kMaxLog10Nfa = -2;
// Regions of pairs of the same views tell the same thing several times.
constexpr double kMinShareOfBare = 0.2;

// Of views, or of groups of them.
using RegionsOfPairs = std::map<ViewPair, OverlapRegions>;

RegionsOfPairs RegionsOf(const ExpectedOverlaps& overlaps) {
  RegionsOfPairs regions;
  for (const auto& [views, overlap] : overlaps) {
    if (overlap.share >= kMinShareOfAlike) {
      regions.emplace(views, overlap.regions);
    }
  }
  return regions;
}

// Views that grow together by the evidence between them.
class Groups {
 public:
  Groups(const Scene& scene, const std::vector<ViewPair>& links,
         RegionsOfPairs regions)
      : regions_(std::move(regions)),
        log10_num_(std::log10(static_cast<double>(regions_.size()))) {
    for (const ViewPair& views : links) {
      const RelativePose& pose = scene.relative_poses.at(views);
      evidence_[views] = EvidenceOfNfa(pose.weakness ? 0 : pose.log10_nfa);
      for (const ViewId view : {views.first, views.second}) {
        group_of_.emplace(view, view);
      }
    }
  }

  bool AreDifferent(const ViewPair& groups) const {
    const auto regions = regions_.find(groups);
    return regions != regions_.end() &&
           regions->second.num_bare >= kMinShareOfBare * regions->second.num &&
           log10_num_ + Log10ChanceOfBare(regions->second) <= kMaxLog10Nfa;
  }

  std::vector<ViewPair> FindDifferent() const {
    std::vector<ViewPair> different;
    for (const auto& entry : regions_) {
      if (AreDifferent(entry.first)) different.push_back(entry.first);
    }
    return different;
  }

  void Grow() {
    for (;;) {
      const ViewPair* best = nullptr;
      double most = 0;
      for (const auto& [groups, evidence] : evidence_) {
        if (evidence > most && !AreDifferent(groups)) {
          best = &groups;
          most = evidence;
        }
      }
      if (best == nullptr) return;
      Join(*best);
    }
  }

  bool AreApart(const ViewPair& views) const {
    return group_of_.at(views.first) != group_of_.at(views.second);
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
  // The second group becomes a part of the first.
  void Join(const ViewPair& groups) {
    const auto [first, second] = groups;
    for (auto& entry : group_of_) {
      if (entry.second == second) entry.second = first;
    }
    const auto join_pairs = [&](auto* of_pairs) {
      std::remove_reference_t<decltype(*of_pairs)> joined;
      for (const auto& [pair, value] : *of_pairs) {
        const ViewId a = pair.first == second ? first : pair.first;
        const ViewId b = pair.second == second ? first : pair.second;
        if (a != b) joined[OrderedPair(a, b)] += value;
      }
      *of_pairs = std::move(joined);
    };
    join_pairs(&evidence_);
    join_pairs(&regions_);
  }

  std::map<ViewId, ViewId> group_of_;  // named by one of its views
  EvidenceOfPairs evidence_;           // between groups
  RegionsOfPairs regions_;             // the same
  double log10_num_ = 0;               // of pairs of views
};

}  // namespace

LookAlikes FindLookAlikes(const Scene& scene, const PoseSummary& summary,
                          const ExpectedOverlaps& overlaps) {
  LookAlikes found;
  const ViewGraph agreeing = AgreeingPoses(scene, summary);
  Groups groups(scene, agreeing.pairs(), RegionsOf(overlaps));
  found.different = groups.FindDifferent();
  if (found.different.empty()) return found;
  groups.Grow();
  for (const ViewPair& views : agreeing.pairs()) {
    if (groups.AreApart(views)) found.false_poses.push_back(views);
  }
  if (!found.false_poses.empty()) found.doubtful = groups.ViewsOfOthers();
  return found;
}

}  // namespace lowlap
