#include "lowlap/pipeline/calibrate_images.h"

#include <utility>

#include "lowlap/matching/pair_selection.h"
#include "lowlap/pipeline/scene_reduction.h"

namespace lowlap {
Status FrontEndOptions::Validate() const {
  for (const Status& valid :
       {features.Validate(), matching.Validate(), relative_poses.Validate()}) {
    if (!valid) return valid;
  }
  return {};
}

Result<std::vector<PairReport>> MeasureImages(Scene* scene,
                                              const FrontEndOptions& options,
                                              const RunContext& context,
                                              StageLog* stages) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  const auto pairs = SelectPairs(*scene, options.pairs);
  if (!pairs) return tl::unexpected<Error>(pairs.error());

  std::map<ViewId, DetectedFeatures> detected;
  {
    const StageLog::Scope scope(stages, "features");
    auto result = DetectFeatures(*scene, options.features, context);
    if (!result) return tl::unexpected<Error>(result.error());
    detected = std::move(*result);
  }
  std::map<ViewPair, PairMatches> matches;
  {
    const StageLog::Scope scope(stages, "matching");
    auto result = MatchFeatures(detected, *pairs, options.matching, context);
    if (!result) return tl::unexpected<Error>(result.error());
    matches = std::move(*result);
  }
  for (auto& [view, features] : detected) {
    scene->features[view] = std::move(features.features);
  }
  detected.clear();
  const StageLog::Scope scope(stages, "relative poses");
  auto reports =
      EstimateRelativePoses(scene, matches, options.relative_poses, context);
  if (reports) KeepMatchedFeatures(scene);
  return reports;
}

}  // namespace lowlap
