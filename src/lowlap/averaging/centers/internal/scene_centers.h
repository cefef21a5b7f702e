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
  /// Robust deviation of the directions from the centres of the first solution,
  /// as far as `outlier_reach` of it are little (kLittleOfDirectionsDeg); 0
  /// without any.
  double sigma_rad = 0;

  std::set<ViewId> PlacedViews() const;
};

/// The centres under averaged rotations, as SolveScenePoses says: with ratios
/// that are weak for views that nothing else places, and without relative poses
/// whose directions contradict the centres. It is done without the relative
/// poses `without` from the start; those of them that agree with what comes out
/// are taken in again, unless the ratios across them mostly disagree. Errors:
/// those of the strategy.
Result<SceneCenters> SolveSceneCenters(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const std::vector<ViewPair>& without,
                                       const PoseOptions& options,
                                       const RunContext& context);

}  // namespace lowlap
