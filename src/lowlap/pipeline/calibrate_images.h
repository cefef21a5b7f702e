#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/features.h"
#include "lowlap/matching/matching.h"
#include "lowlap/pipeline/relative_poses.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct FrontEndOptions {
  std::string pairs = "all";  // see SelectPairs
  FeatureOptions features;
  MatchOptions matching;
  RelativePoseOptions relative_poses;

  Status Validate() const;
};

/// From photographs to measurements: detects features in the images of all
/// views, matches the selected pairs, and fills scene->features,
/// relative_poses and tracks. Features that no inlier uses are dropped
/// (KeepMatchedFeatures), so that the scene stays small.
Result<std::vector<PairReport>> MeasureImages(Scene* scene,
                                              const FrontEndOptions& options,
                                              const RunContext& context,
                                              StageLog* stages);

}  // namespace lowlap
