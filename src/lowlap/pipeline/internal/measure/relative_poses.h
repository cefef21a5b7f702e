#pragma once

#include <map>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/matching/internal/tracks.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/internal/pair_estimator.h"

namespace lowlap {

/// Fills scene->relative_poses, unrelated_pairs, point_tracks and line_tracks
/// from putative matches of the scene's features: EstimatePair for every pair,
/// once more without matches that those of other pairs contradict
/// (ExamineLoops) where a pose stands on such, then tracks. A match that holds
/// a relative pose alone (TwoViewResult) is no inlier unless a third view sees
/// it, too.
///
/// Pairs that fail get no relative pose. Those without a meaningful one are
/// unrelated, beside what the scene lists and `matches` does not; the report
/// says why, and pairs without parallax are named in the log. `detected` as in
/// MeasureView, for all views; null: matches are all there is. Pairs of `given`
/// are not estimated, but taken (TakePair): cam2_from_cam1.
///
/// The result does not depend on the number of threads.
Result<std::vector<PairReport>> EstimateRelativePoses(
    Scene* scene, const std::map<ViewPair, PairMatches>& matches,
    const std::map<ViewId, DetectedFeatures>* detected,
    const RelativePoseOptions& options, const RunContext& context,
    const std::map<ViewPair, RigidTransform>& given = {});

/// The relative poses refined once more, each on its inliers, after features
/// have moved; tracks are built anew. `detected` as above.
Status RefineRelativePoses(Scene* scene,
                           const std::map<ViewId, DetectedFeatures>& detected,
                           const RelativePoseOptions& options,
                           const RunContext& context);

}  // namespace lowlap
