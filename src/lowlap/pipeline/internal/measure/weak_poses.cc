#include "lowlap/pipeline/internal/measure/weak_poses.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "lowlap/core/internal/union_find.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// More than that between the rotations of a pair, and they are two motions.
const double kSameRotationRad = RadFromDeg(5);

std::string Explanation(PoseWeakness weakness) {
  switch (weakness) {
    case PoseWeakness::kMatchesSideBySide:
      return "only matches side by side agree with a motion, which things that "
             "look alike do, too";
    case PoseWeakness::kSurroundings:
      return "what surrounds the matches does not match, as it is where things "
             "look alike";
    case PoseWeakness::kRepeats:
      return "nearly all that agrees with a motion repeats within the "
             "photographs, and would agree elsewhere, too";
  }
  return "";
}

// A spanning forest of relative poses, in which every path has the most
// evidence that its weakest link can have.
class StrongestPaths {
 public:
  struct Path {
    Mat3 second_from_first = Mat3::Identity();
    double log10_nfa = 0;  // of the weakest link
  };

  explicit StrongestPaths(std::vector<const RelativePose*> poses) {
    std::stable_sort(poses.begin(), poses.end(),
                     [](const auto* a, const auto* b) {
                       return a->log10_nfa < b->log10_nfa;
                     });
    std::map<ViewId, std::size_t> index;
    for (const RelativePose* pose : poses) {
      index.emplace(pose->views.first, index.size());
      index.emplace(pose->views.second, index.size());
    }
    UnionFind joined(index.size());
    for (const RelativePose* pose : poses) {
      const auto [first, second] = pose->views;
      if (!joined.Union(index.at(first), index.at(second))) continue;
      links_[first].push_back({second, pose->rotation, pose->log10_nfa});
      links_[second].push_back(
          {first, pose->rotation.transpose(), pose->log10_nfa});
    }
  }

  // nullopt: nothing joins the two.
  std::optional<Path> Find(const ViewPair& views) const {
    std::map<ViewId, Path> reached = {
        {views.first, {Mat3::Identity(), -HUGE_VAL}}};
    std::vector<ViewId> queue = {views.first};
    for (std::size_t n = 0; n < queue.size(); ++n) {
      const auto links = links_.find(queue[n]);
      if (links == links_.end()) break;
      const Path here = reached.at(queue[n]);
      for (const Link& link : links->second) {
        const Path path = {link.to_from_here * here.second_from_first,
                           std::max(here.log10_nfa, link.log10_nfa)};
        if (link.to == views.second) return path;
        if (reached.emplace(link.to, path).second) queue.push_back(link.to);
      }
    }
    return std::nullopt;
  }

 private:
  struct Link {
    ViewId to;
    Mat3 to_from_here;
    double log10_nfa;
  };

  std::map<ViewId, std::vector<Link>> links_;
};

bool IsKept(const RelativePose& weak, const StrongestPaths& others) {
  const std::optional<StrongestPaths::Path> path = others.Find(weak.views);
  if (!path || weak.log10_nfa < path->log10_nfa) return true;
  return 2 * weak.log10_nfa < path->log10_nfa &&
         RotationAngleBetween(weak.rotation, path->second_from_first) <=
             kSameRotationRad;
}

}  // namespace

void DropWeakPoses(std::vector<PairEstimate>* estimates) {
  std::vector<const RelativePose*> others;
  for (const PairEstimate& estimate : *estimates) {
    if (estimate.pose && !estimate.pose->weakness) {
      others.push_back(&*estimate.pose);
    }
  }
  const StrongestPaths paths(std::move(others));
  for (PairEstimate& estimate : *estimates) {
    if (!estimate.pose || !estimate.pose->weakness ||
        IsKept(*estimate.pose, paths)) {
      continue;
    }
    estimate.reason = Explanation(*estimate.pose->weakness) +
                      "; other relative poses join the views";
    estimate.pose.reset();
  }
}

}  // namespace lowlap
