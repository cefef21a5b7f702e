#include "lowlap/study/internal/robustness/problem.h"

#include <map>
#include <utility>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/scale_ratios.h"

namespace lowlap {

Result<SimulatedProblem> SimulateProblem(const RobustnessLevel& level,
                                         std::uint64_t seed,
                                         const RunContext& context) {
  SyntheticOptions options = level.scene;
  options.seed = seed;
  LOWLAP_ASSIGN_OR_RETURN(auto synthetic, Simulate(options));
  Scene& scene = synthetic.scene;
  if (level.has_features) {
    LOWLAP_ASSIGN_OR_RETURN(scene.scale_ratios,
                            EstimateScaleRatios(scene, level.scale, context));
  } else {
    SimulatedRatioOptions ratios = level.ratios;
    ratios.seed = seed;
    LOWLAP_RETURN_IF_ERROR(SimulateRatios(ratios, &synthetic));
  }
  std::map<ViewId, Mat3> rotations;
  std::vector<ViewPair> excluded;
  if (level.averages_rotations) {
    LOWLAP_ASSIGN_OR_RETURN(
        auto averaged, AverageSceneRotations(scene, PoseOptions(), context));
    rotations = std::move(averaged.cam_from_world);
    for (const OutlierEdge& edge : averaged.outliers) {
      excluded.push_back(edge.views);
    }
  } else {
    for (const auto& [view, pose] : synthetic.true_poses) {
      rotations[view] = pose.rotation;
    }
  }
  SimulatedProblem made;
  made.problem =
      MakeTranslationProblem(scene, rotations, excluded, {}, level.HasTracks());
  Mat3 sum = Mat3::Zero();
  for (const auto& [view, rotation] : rotations) {
    sum += synthetic.true_poses.at(view).rotation.transpose() * rotation;
    made.true_centers.push_back(synthetic.true_poses.at(view).center);
  }
  made.truth_from_solved = NearestRotation(sum);
  return made;
}

}  // namespace lowlap
