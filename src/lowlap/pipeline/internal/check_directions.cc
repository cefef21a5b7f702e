#include "lowlap/pipeline/internal/check_directions.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/scene/features.h"
#include "lowlap/two_view/internal/direction_check.h"

namespace lowlap {
namespace {

struct CheckedView {
  NormalizedFeatures features;
  Vec2 image_size_px = Vec2::Zero();
};

std::map<ViewId, CheckedView> ViewsToCheck(const Scene& scene) {
  std::map<ViewId, CheckedView> views;
  for (const auto& [view, features] : scene.features) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(view);
    if (intrinsic == nullptr) continue;
    const Vec2 size_px(intrinsic->width_px, intrinsic->height_px);
    if (!(size_px.minCoeff() > 0)) continue;
    views[view] = {NormalizeFeatures(features, *intrinsic), size_px};
  }
  return views;
}

DirectionCheck Check(const RelativePose& pose, const CheckedView& first,
                     const CheckedView& second, const ErrorLimits& limits,
                     std::uint64_t seed) {
  TwoViewInput input;
  input.views = pose.views;
  input.features1 = &first.features;
  input.features2 = &second.features;
  input.point_matches = pose.point_inliers;
  input.line_matches = pose.line_inliers;
  input.image_size1_px = first.image_size_px;
  input.image_size2_px = second.image_size_px;
  return CheckDirection(input, pose,
                        limits.DirectionRad(0, DirectionStddev(pose)), seed);
}

}  // namespace

Result<MatchVerdicts> CheckDirections(Scene* scene, const PoseOptions& options,
                                      const RunContext& context) {
  const std::map<ViewId, CheckedView> views = ViewsToCheck(*scene);
  const ErrorLimits limits = LimitsOf(options);
  std::vector<RelativePose*> poses;
  for (auto& entry : scene->relative_poses) {
    if (entry.second.alternatives.empty()) poses.push_back(&entry.second);
  }
  std::vector<DirectionCheck> checks(poses.size());
  const Status done =
      ParallelFor(context, "matches", poses.size(), [&](std::size_t n) {
        const RelativePose& pose = *poses[n];
        const auto first = views.find(pose.views.first);
        const auto second = views.find(pose.views.second);
        if (first == views.end() || second == views.end()) return;
        checks[n] = Check(pose, first->second, second->second, limits,
                          PairSeed(context.seed, pose.views));
      });
  if (!done) return tl::unexpected<Error>(done.error());
  MatchVerdicts verdicts;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const ViewPair pair = poses[n]->views;
    switch (checks[n].verdict) {
      case DirectionVerdict::kBorneOut:
        break;
      case DirectionVerdict::kUntold:
        verdicts.untold.push_back(pair);
        break;
      case DirectionVerdict::kRefuted:
        verdicts.refuted.push_back(pair);
        break;
      case DirectionVerdict::kReplaced:
        *poses[n] = std::move(*checks[n].replacement);
        verdicts.replaced.push_back({pair, DegFromRad(checks[n].error_rad)});
        break;
    }
  }
  const bool has_points = std::any_of(
      poses.begin(), poses.end(),
      [](const RelativePose* pose) { return !pose->point_inliers.empty(); });
  if (!has_points && verdicts.untold.size() == poses.size()) {
    verdicts.untold.clear();
  }
  return verdicts;
}

}  // namespace lowlap
