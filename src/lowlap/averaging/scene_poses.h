#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/averaging/rotation_averaging.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct PoseOptions {
  std::string strategy = "graph";
  RotationAveragingOptions rotation;
  /// A relative pose whose rotation disagrees with the averaged ones by more
  /// than this many robust standard deviations of all residuals is left out.
  double outlier_reach = 5.0;

  Status Validate() const;
};

/// What became of the views and edges on the way to absolute poses.
struct PoseSummary {
  int num_views = 0;
  int num_placed = 0;
  /// Views by component; component 0 is the one whose poses the scene gets.
  std::vector<std::vector<ViewId>> components;
  std::vector<ViewId> unplaced;
  std::vector<ViewPair> outlier_edges;
  int num_edges = 0;
  int num_ratios = 0;
  double median_rotation_residual_deg = 0;
};

/// scene.poses from scene.relative_poses and scene.scale_ratios: rotation
/// averaging over all relative poses, outlier edges named and left out, then
/// the chosen translation strategy. The poses of the largest component replace
/// scene.poses; the others have no common scale with it and are listed.
/// Gauge: the first placed view has rotation identity and centre 0, and the
/// mean length of the placed edges is 1.
Result<PoseSummary> SolveScenePoses(Scene* scene, const PoseOptions& options,
                                    const RunContext& context);

}  // namespace lowlap
