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

// The rounds in which pairs are asked and take another motion.
class Reconsideration {
 public:
  Reconsideration(const std::vector<ViewPair>& pairs, const PairInputs& inputs,
                  Scene* scene, const PoseOptions& options,
                  const RunContext& context)
      : inputs_(inputs),
        scene_(*scene),
        context_(context),
        paths_(*scene,
               RadFromDeg(options.least_false_deg) / options.outlier_reach) {
    candidates_.reserve(pairs.size());
    for (const ViewPair& views : pairs) {
      candidates_.push_back({views, std::nullopt, {}});
    }
  }

  Result<std::vector<ReconsideredPose>> Run() {
    do {
      const Status asked =
          ParallelFor(context_, "loops", candidates_.size(),
                      [&](std::size_t n) { Ask(&candidates_[n]); });
      if (!asked) {
        TakeAllBack();
        return tl::unexpected<Error>(asked.error());
      }
    } while (TakeThoseThatGain());
    std::sort(taken_.begin(), taken_.end(),
              [](const ReconsideredPose& a, const ReconsideredPose& b) {
                return a.views < b.views;
              });
    return taken_;
  }

 private:
  // What the pair gains by its prior, unless that is the one it had before.
  void Ask(Candidate* candidate) const {
    const auto prior = paths_.Find(candidate->views);
    if (SameRotation(prior, candidate->prior)) return;
    candidate->prior = prior;
    candidate->informed = {};
    if (!prior) return;
    const RelativePose& pose = scene_.relative_poses.at(candidate->views);
    const auto input = inputs_.Of(pose);
    if (!input ||
        PriorPenalty(prior->rotation, pose.rotation) < kLeastGainDigits) {
      return;
    }
    InformedPose informed =
        InformPose(*input, pose, prior->rotation,
                   PairSeed(context_.seed, candidate->views));
    if (std::min(informed.gained_digits, informed.prior_digits) >=
            kLeastGainDigits &&
        Agrees(informed.pose.rotation, paths_.VarianceOf(informed.pose),
               prior->rotation)) {
      candidate->informed = std::move(informed);
    }
  }

  // Whether there were any. Of those on one another's paths only the one that
  // gains most is taken.
  bool TakeThoseThatGain() {
    std::stable_sort(candidates_.begin(), candidates_.end(), GainsMore);
    std::set<ViewPair> involved;  // replaced, or on the path of what was
    std::vector<Candidate> left;
    for (Candidate& candidate : candidates_) {
      if (candidate.informed.gained_digits == 0 ||
          IsInvolved(candidate, involved)) {
        left.push_back(std::move(candidate));
        continue;
      }
      involved.insert(candidate.views);
      involved.insert(candidate.prior->path.begin(),
                      candidate.prior->path.end());
      Take(candidate.views, std::move(candidate.informed));
    }
    candidates_ = std::move(left);
    return !involved.empty();
  }

  void Take(const ViewPair& views, InformedPose informed) {
    RelativePose& pose = scene_.relative_poses.at(views);
    const double turn_rad =
        RotationAngleBetween(pose.rotation, informed.pose.rotation);
    taken_.push_back({views, DegFromRad(turn_rad), informed.gained_digits});
    LogReconsidered(taken_.back(), scene_, context_);
    paths_.Replace(informed.pose);
    before_.emplace(views, std::move(pose));
    pose = std::move(informed.pose);
  }

  void TakeAllBack() {
    for (auto& [views, pose] : before_) {
      scene_.relative_poses.at(views) = std::move(pose);
    }
  }

  const PairInputs& inputs_;
  Scene& scene_;
  const RunContext& context_;
  RotationPaths paths_;
  std::vector<Candidate> candidates_;  // that have taken nothing yet
  std::vector<ReconsideredPose> taken_;
  std::map<ViewPair, RelativePose> before_;
};

}  // namespace

Result<std::vector<ReconsideredPose>> ReconsiderPoses(
    Scene* scene, const PoseOptions& options, const RunContext& context) {
  const std::vector<ViewPair> pairs = PairsToAsk(*scene);
  if (pairs.empty()) return std::vector<ReconsideredPose>();
  PairInputs inputs(*scene);
  LOWLAP_RETURN_IF_ERROR(inputs.FindDirections(pairs, context));
  return Reconsideration(pairs, inputs, scene, options, context).Run();
}

}  // namespace lowlap
