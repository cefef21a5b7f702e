#pragma once

#include <set>
#include <vector>

#include "lowlap/averaging/scene_poses.h"

namespace lowlap {

/// The centres of a scene, and of what they were made.
struct SceneCenters {
  TranslationProblem problem;  // of what is in use
  TranslationSolution solution;
  std::vector<OutlierEdge> outlier_edges;  // left out, by views
  /// As in PoseSummary.
  std::vector<OutlierEdge> kept_outliers;
  std::vector<ViewTriplet> left_out_ratios;
  std::set<ViewTriplet> weak_ratios;
  /// Robust deviation of the directions from the centres; 0 without any.
  double sigma_rad = 0;
};

/// The centres under averaged rotations, as SolveScenePoses says: with ratios
/// that are weak for views that nothing else places, and without relative poses
/// whose directions contradict the centres. Errors: those of the strategy.
Result<SceneCenters> SolveSceneCenters(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const PoseOptions& options,
                                       const RunContext& context);

}  // namespace lowlap
