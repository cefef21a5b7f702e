#include "lowlap/pipeline/internal/decisions/reconsider_poses.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/pipeline/internal/decisions/rotation_paths.h"
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

// Pairs of few matches that are on a cycle.
std::vector<ViewPair> PairsToAsk(const Scene& scene) {
  const std::vector<ViewPair> bridges = FindBridges(ViewGraph(scene));
  std::vector<ViewPair> pairs;
  for (const auto& [views, pose] : scene.relative_poses) {
    if (pose.point_inliers.size() + pose.line_inliers.size() < kFewMatches &&
        !std::binary_search(bridges.begin(), bridges.end(), views)) {
      pairs.push_back(views);
    }
  }
  return pairs;
}

bool Agrees(const Mat3& rotation, double variance, const RotationPrior& prior) {
  const double off = RotationAngleBetween(prior.cam2_from_cam1, rotation);
  return off * off <=
         kAgreesBelow * (prior.stddev_rad * prior.stddev_rad + variance);
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
              scene.NameOf(pose.views.first) + " and " +
                  scene.NameOf(pose.views.second) +
                  Format(": turned by %.2f degrees; the rest of the scene asks "
                         "for it, and their few matches allow it",
                         pose.rotation_deg));
}

}  // namespace

Result<std::vector<ReconsideredPose>> ReconsiderPoses(
    Scene* scene, const PoseOptions& options, const RunContext& context) {
  const std::vector<ViewPair> pairs = PairsToAsk(*scene);
  std::vector<ReconsideredPose> reconsidered;
  if (pairs.empty()) return reconsidered;
  PairInputs inputs(*scene);
  LOWLAP_RETURN_IF_ERROR(inputs.FindDirections(pairs, context));
  RotationPaths paths(
      *scene, RadFromDeg(options.least_false_deg) / options.outlier_reach);
  std::vector<Candidate> candidates;
  candidates.reserve(pairs.size());
  for (const ViewPair& views : pairs) {
    candidates.push_back({views, std::nullopt, {}});
  }
  std::map<ViewPair, RelativePose> before;
  for (bool changed = true; changed;) {
    const Status done =
        ParallelFor(context, "loops", candidates.size(), [&](std::size_t n) {
          const auto prior = paths.Find(candidates[n].views);
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
              Agrees(informed.pose.rotation, paths.VarianceOf(informed.pose),
                     prior->rotation)) {
            candidates[n].informed = std::move(informed);
          }
        });
    if (!done) {
      for (auto& [views, pose] : before) {
        scene->relative_poses.at(views) = std::move(pose);
      }
      return tl::unexpected<Error>(done.error());
    }
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
      RelativePose& pose = scene->relative_poses.at(candidate.views);
      const double turn_rad =
          RotationAngleBetween(pose.rotation, candidate.informed.pose.rotation);
      reconsidered.push_back({candidate.views, DegFromRad(turn_rad),
                              candidate.informed.gained_digits});
      LogReconsidered(reconsidered.back(), *scene, context);
      paths.Replace(candidate.informed.pose);
      before.emplace(candidate.views, std::move(pose));
      pose = std::move(candidate.informed.pose);
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
