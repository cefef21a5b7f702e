#include "lowlap/pipeline/internal/reconsider_poses.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/pipeline/internal/pair_inputs.h"
#include "lowlap/scene/view_graph.h"
#include "lowlap/two_view/internal/informed_pose.h"

namespace lowlap {
namespace {

/// Point and line matches; more tell a motion well enough.
constexpr std::size_t kFewMatches = 200;
/// 95 % of squared errors with three degrees of freedom, in variances.
constexpr double kAgreesBelow = 7.81;
constexpr double kLeastGainDigits = 1;
/// A prior that is vaguer than this tells no two motions apart.
constexpr double kMaxPriorStddevDeg = 5;

struct Link {
  ViewId to;
  Mat3 to_from_here;
  double variance;
};

// What the rest of the scene says about a pair, and through which pairs.
struct PathPrior {
  RotationPrior rotation;
  std::vector<ViewPair> path;
};

class Reconsidering {
 public:
  Reconsidering(Scene* scene, const PoseOptions& options)
      : scene_(*scene),
        floor_rad_(RadFromDeg(options.least_false_deg) /
                   options.outlier_reach) {
    for (const auto& entry : scene_.relative_poses) Connect(entry.second);
  }

  /// Pairs of few matches that are on a cycle.
  std::vector<ViewPair> PairsToAsk() const {
    const std::vector<ViewPair> bridges = FindBridges(ViewGraph(scene_));
    std::vector<ViewPair> pairs;
    for (const auto& [views, pose] : scene_.relative_poses) {
      if (pose.point_inliers.size() + pose.line_inliers.size() < kFewMatches &&
          !std::binary_search(bridges.begin(), bridges.end(), views)) {
        pairs.push_back(views);
      }
    }
    return pairs;
  }

  /// Along the most certain path between the views that avoids the pair
  /// (Dijkstra's algorithm on variances); nullopt: there is none.
  std::optional<PathPrior> PriorOf(const ViewPair& views) const {
    struct Reached {
      double variance;
      Mat3 here_from_first;
      ViewId from;
    };
    using State = std::pair<double, ViewId>;
    const double max_variance = std::pow(RadFromDeg(kMaxPriorStddevDeg), 2);
    std::map<ViewId, Reached> reached;
    std::set<ViewId> done;
    std::priority_queue<State, std::vector<State>, std::greater<>> open;
    reached[views.first] = {0, Mat3::Identity(), views.first};
    open.push({0, views.first});
    while (!open.empty() && open.top().second != views.second) {
      const ViewId here = open.top().second;
      open.pop();
      const auto links = links_.find(here);
      if (!done.insert(here).second || links == links_.end()) continue;
      const Reached at_here = reached.at(here);
      for (const Link& link : links->second) {
        const double variance = at_here.variance + link.variance;
        const auto known = reached.find(link.to);
        if (OrderedPair(here, link.to) == views || variance > max_variance ||
            (known != reached.end() && known->second.variance <= variance)) {
          continue;
        }
        reached[link.to] = {variance,
                            link.to_from_here * at_here.here_from_first, here};
        open.push({variance, link.to});
      }
    }
    if (open.empty()) return std::nullopt;
    const Reached& end = reached.at(views.second);
    PathPrior prior{{end.here_from_first, std::sqrt(end.variance)}, {}};
    for (ViewId view = views.second; view != views.first;) {
      const ViewId from = reached.at(view).from;
      prior.path.push_back(OrderedPair(from, view));
      view = from;
    }
    return prior;
  }

  bool Agrees(const RelativePose& pose, const RotationPrior& prior) const {
    const double off =
        RotationAngleBetween(prior.cam2_from_cam1, pose.rotation);
    return off * off <= kAgreesBelow * (prior.stddev_rad * prior.stddev_rad +
                                        VarianceOf(pose));
  }

  void Replace(RelativePose pose) {
    for (const ViewId view : {pose.views.first, pose.views.second}) {
      const ViewId other =
          view == pose.views.first ? pose.views.second : pose.views.first;
      std::vector<Link>& links = links_[view];
      links.erase(
          std::remove_if(links.begin(), links.end(),
                         [&](const Link& link) { return link.to == other; }),
          links.end());
    }
    Connect(pose);
    scene_.relative_poses.at(pose.views) = std::move(pose);
  }

 private:
  double VarianceOf(const RelativePose& pose) const {
    const double stated = RotationStddev(pose);
    return stated * stated + floor_rad_ * floor_rad_;
  }

  // A pose of unknown deviation is no prior.
  void Connect(const RelativePose& pose) {
    if (!pose.covariance) return;
    const double variance = VarianceOf(pose);
    links_[pose.views.first].push_back(
        {pose.views.second, pose.rotation, variance});
    links_[pose.views.second].push_back(
        {pose.views.first, pose.rotation.transpose(), variance});
  }

  Scene& scene_;
  double floor_rad_;
  std::map<ViewId, std::vector<Link>> links_;
};

struct Candidate {
  ViewPair views;
  std::optional<PathPrior> prior;
  InformedPose informed;  // with this prior; without gain: nothing to take
};

bool GainsMore(const Candidate& a, const Candidate& b) {
  return a.informed.gained_digits != b.informed.gained_digits
             ? a.informed.gained_digits > b.informed.gained_digits
             : a.views < b.views;
}

bool SameRotation(const std::optional<PathPrior>& a,
                  const std::optional<PathPrior>& b) {
  return a && b && a->rotation.cam2_from_cam1 == b->rotation.cam2_from_cam1 &&
         a->rotation.stddev_rad == b->rotation.stddev_rad;
}

bool IsInvolved(const Candidate& candidate, const std::set<ViewPair>& pairs) {
  return pairs.count(candidate.views) > 0 ||
         std::any_of(candidate.prior->path.begin(), candidate.prior->path.end(),
                     [&](const ViewPair& p) { return pairs.count(p) > 0; });
}

void LogReconsidered(const ReconsideredPose& pose, const Scene& scene,
                     const RunContext& context) {
  context.Log(LogLevel::kInfo,
              scene.views.at(pose.views.first).filename + " and " +
                  scene.views.at(pose.views.second).filename +
                  Format(": turned by %.2f degrees; the rest of the scene asks "
                         "for it, and their few matches allow it",
                         pose.rotation_deg));
}

}  // namespace

Result<std::vector<ReconsideredPose>> ReconsiderPoses(
    Scene* scene, const PoseOptions& options, const RunContext& context) {
  Reconsidering reconsidering(scene, options);
  std::vector<ReconsideredPose> reconsidered;
  std::vector<Candidate> candidates;
  for (const ViewPair& views : reconsidering.PairsToAsk()) {
    candidates.push_back({views, std::nullopt, {}});
  }
  if (candidates.empty()) return reconsidered;
  PairInputs inputs(*scene);
  for (const Candidate& candidate : candidates) {
    inputs.FindDirectionsOf(candidate.views.first);
    inputs.FindDirectionsOf(candidate.views.second);
  }
  for (bool changed = true; changed;) {
    const Status done =
        ParallelFor(context, "loops", candidates.size(), [&](std::size_t n) {
          const auto prior = reconsidering.PriorOf(candidates[n].views);
          if (SameRotation(prior, candidates[n].prior)) return;
          candidates[n].prior = prior;
          candidates[n].informed = {};
          if (!prior) return;
          const RelativePose& pose =
              scene->relative_poses.at(candidates[n].views);
          const auto input = inputs.Of(pose);
          if (!input ||
              PriorPenalty(prior->rotation, pose.rotation) < kLeastGainDigits) {
            return;
          }
          InformedPose informed =
              InformPose(*input, pose, prior->rotation,
                         PairSeed(context.seed, candidates[n].views));
          if (std::min(informed.gained_digits, informed.prior_digits) >=
                  kLeastGainDigits &&
              reconsidering.Agrees(informed.pose, prior->rotation)) {
            candidates[n].informed = std::move(informed);
          }
        });
    if (!done) return tl::unexpected<Error>(done.error());
    std::stable_sort(candidates.begin(), candidates.end(), GainsMore);
    changed = false;
    std::set<ViewPair> involved;  // replaced, or on the path of what was
    std::vector<Candidate> left;
    for (Candidate& candidate : candidates) {
      if (candidate.informed.gained_digits == 0 ||
          IsInvolved(candidate, involved)) {
        left.push_back(std::move(candidate));
        continue;
      }
      changed = true;
      involved.insert(candidate.views);
      involved.insert(candidate.prior->path.begin(),
                      candidate.prior->path.end());
      const double turn_rad = RotationAngleBetween(
          scene->relative_poses.at(candidate.views).rotation,
          candidate.informed.pose.rotation);
      reconsidered.push_back({candidate.views, DegFromRad(turn_rad),
                              candidate.informed.gained_digits});
      LogReconsidered(reconsidered.back(), *scene, context);
      reconsidering.Replace(std::move(candidate.informed.pose));
    }
    candidates = std::move(left);
  }
  std::sort(reconsidered.begin(), reconsidered.end(),
            [](const ReconsideredPose& a, const ReconsideredPose& b) {
              return a.views < b.views;
            });
  return reconsidered;
}

}  // namespace lowlap
