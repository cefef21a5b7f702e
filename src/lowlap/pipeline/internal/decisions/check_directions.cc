#include "lowlap/pipeline/internal/decisions/check_directions.h"

#include <algorithm>
#include <utility>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/pipeline/internal/pair_inputs.h"
#include "lowlap/two_view/internal/direction_check.h"

namespace lowlap {

Result<MatchVerdicts> CheckDirections(Scene* scene, const PoseOptions& options,
                                      const RunContext& context) {
  const PairInputs inputs(*scene);
  const ErrorLimits limits = LimitsOf(options);
  std::vector<RelativePose*> poses;
  for (auto& entry : scene->relative_poses) {
    if (entry.second.alternatives.empty()) poses.push_back(&entry.second);
  }
  std::vector<DirectionCheck> checks(poses.size());
  const Status done =
      ParallelFor(context, "matches", poses.size(), [&](std::size_t n) {
        const RelativePose& pose = *poses[n];
        const auto input = inputs.Of(pose);
        if (!input) return;
        checks[n] = CheckDirection(
            *input, pose, limits.DirectionRad(0, DirectionStddev(pose)),
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
