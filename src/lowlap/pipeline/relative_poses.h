#pragma once

#include <map>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/features.h"
#include "lowlap/matching/guided_line_matching.h"
#include "lowlap/matching/guided_point_matching.h"
#include "lowlap/matching/line_filter.h"
#include "lowlap/matching/matching.h"
#include "lowlap/matching/tracks.h"
#include "lowlap/pipeline/pair_report.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/relative_pose_estimator.h"

namespace lowlap {

struct RelativePoseOptions {
  TwoViewOptions two_view;
  /// What the relative poses are estimated from; at least one.
  bool use_points = true;
  bool use_lines = true;
  VanishingOptions vanishing;
  GuidedLineOptions guided_lines;
  GuidedPointOptions guided_points;
  /// Points are matched again under the first pose if it has fewer inliers.
  int starved_below = 2000;
  LineFilterOptions line_filter;
  LineTrackOptions line_tracks;

  Status Validate() const;
};

/// Fills scene->relative_poses, point_tracks and line_tracks from putative
/// matches of the scene's features: a-contrario relative pose per pair from
/// points and lines, then the line matches that are plausible under it, then
/// tracks. Pairs that fail, or whose direction is undetermined (pure rotation),
/// get no relative pose; the report says why. Where two motions explain what
/// the pair sees, the pose keeps the other one as an alternative.
///
/// With `detected`, what the detectors know of the same features (same order),
/// the shapes of the points' errors count, lines and, for starved pairs, points
/// are matched again under the first pose, and the pose is refined on all of
/// them. Null: matches are all there is.
///
/// The result does not depend on the number of threads.
Result<std::vector<PairReport>> EstimateRelativePoses(
    Scene* scene, const std::map<ViewPair, PairMatches>& matches,
    const std::map<ViewId, DetectedFeatures>* detected,
    const RelativePoseOptions& options, const RunContext& context);

/// The relative poses refined once more, each on its inliers, after features
/// have moved; tracks are built anew. `detected` as above.
Status RefineRelativePoses(Scene* scene,
                           const std::map<ViewId, DetectedFeatures>& detected,
                           const RelativePoseOptions& options,
                           const RunContext& context);

}  // namespace lowlap
