#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/matching/line_filter.h"
#include "lowlap/matching/matching.h"
#include "lowlap/matching/tracks.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/relative_pose_estimator.h"

namespace lowlap {

struct RelativePoseOptions {
  TwoViewOptions two_view;
  LineFilterOptions line_filter;
  LineTrackOptions line_tracks;

  Status Validate() const;
};

/// What became of one pair.
struct PairReport {
  ViewPair views;
  bool accepted = false;
  std::string reason;  // why not, if not
  std::string geometry;
  int num_point_matches = 0;
  int num_line_matches = 0;
  int num_point_inliers = 0;
  int num_line_inliers = 0;
  double log10_nfa = 0;
};

/// Fills scene->relative_poses, point_tracks and line_tracks from putative
/// matches of the scene's features: a-contrario relative pose per pair, then
/// the line matches that are plausible under it, then tracks. Pairs that fail,
/// or whose direction is undetermined (pure rotation), get no relative pose;
/// the report says why. The result does not depend on the number of threads.
Result<std::vector<PairReport>> EstimateRelativePoses(
    Scene* scene, const std::map<ViewPair, PairMatches>& matches,
    const RelativePoseOptions& options, const RunContext& context);

}  // namespace lowlap
