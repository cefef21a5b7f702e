#include "lowlap/pipeline/solve_scene.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/pipeline/decide_motions.h"
#include "lowlap/scale/scale_ratios.h"

namespace lowlap {

Status SolveOptions::Validate() const {
  for (const Status& valid : {scale.Validate(), poses.Validate(),
                              structure.Validate(), adjustment.Validate()}) {
    if (!valid) return valid;
  }
  return {};
}

RatioSummary SummarizeRatios(const std::vector<ScaleRatio>& ratios) {
  RatioSummary summary;
  for (const ScaleRatio& ratio : ratios) {
    ++summary.num_triplets;
    switch (ratio.verdict) {
      case RatioVerdict::kMeaningful:
        ++summary.num_meaningful;
        break;
      case RatioVerdict::kNotMeaningful:
        ++summary.num_not_meaningful;
        break;
      case RatioVerdict::kNoCandidates:
        ++summary.num_without_candidates;
        break;
    }
    summary.num_rejected_negative += ratio.num_rejected_negative;
  }
  return summary;
}

namespace {

// The triplets of the relative poses that are believed: the others have no
// part in the solution, so their ratios would be computed for nothing.
std::vector<ViewTriplet> BelievedTriplets(const Scene& scene,
                                          const SceneRotations& rotations) {
  std::set<ViewPair> outliers;
  for (const OutlierEdge& outlier : rotations.outliers) {
    outliers.insert(outlier.views);
  }
  const auto believed = [&](ViewId a, ViewId b) {
    return outliers.count({std::min(a, b), std::max(a, b)}) == 0;
  };
  std::vector<ViewTriplet> triplets;
  for (const ViewTriplet& views : FindTriplets(scene)) {
    if (believed(views.first, views.middle) &&
        believed(views.middle, views.last)) {
      triplets.push_back(views);
    }
  }
  return triplets;
}

// Relative poses that are a little off bend what many others hold already, but
// may be all that holds a view: they are left out if that loses none.
Result<PoseSummary> SolvePoses(Scene* scene, const SceneRotations& rotations,
                               const PoseOptions& options,
                               const RunContext& context) {
  auto all = SolveScenePoses(scene, rotations, options, context);
  if (!all || options.least_false_deg == 0) return all;
  PoseOptions strict = options;
  strict.least_false_deg = 0;
  const auto fewer = AverageSceneRotations(*scene, strict, context);
  if (!fewer) return all;
  const std::map<PoseId, Pose> poses = scene->poses;
  auto solved = SolveScenePoses(scene, *fewer, strict, context);
  if (solved && solved->num_placed >= all->num_placed &&
      solved->IsDoubtful() <= all->IsDoubtful()) {
    return solved;
  }
  scene->poses = poses;
  return all;
}

}  // namespace

Result<SolveResult> SolveScene(Scene* scene, const SolveOptions& options,
                               const RunContext& context, StageLog* stages) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  SolveResult result;
  SceneRotations rotations;
  {
    const StageLog::Scope scope(stages, "rotations");
    auto motions = DecideMotions(scene, options.scale, options.poses, context);
    if (!motions) return tl::unexpected<Error>(motions.error());
    result.motions = std::move(*motions);
    auto averaged = AverageSceneRotations(*scene, options.poses, context);
    if (!averaged) return tl::unexpected<Error>(averaged.error());
    rotations = std::move(*averaged);
  }
  {
    const StageLog::Scope scope(stages, "scale ratios");
    auto ratios = EstimateScaleRatios(
        *scene, BelievedTriplets(*scene, rotations), options.scale, context);
    if (!ratios) return tl::unexpected<Error>(ratios.error());
    scene->scale_ratios = std::move(*ratios);
    result.ratios = SummarizeRatios(scene->scale_ratios);
  }
  {
    const StageLog::Scope scope(stages, "poses");
    auto poses = SolvePoses(scene, rotations, options.poses, context);
    if (!poses) return tl::unexpected<Error>(poses.error());
    result.poses = std::move(*poses);
    result.poses_before_adjustment = scene->poses;
  }
  {
    const StageLog::Scope scope(stages, "structure");
    auto structure = BuildStructure(scene, options.structure, context);
    if (!structure) return tl::unexpected<Error>(structure.error());
    result.structure = std::move(*structure);
  }
  if (options.adjust) {
    const StageLog::Scope scope(stages, "adjustment");
    auto adjustment = AdjustScene(scene, options.adjustment, context);
    if (!adjustment) return tl::unexpected<Error>(adjustment.error());
    result.adjustment = std::move(*adjustment);
  }
  return result;
}

}  // namespace lowlap
