#include "lowlap/study/internal/robustness/problem.h"

#include <map>
#include <utility>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/scale_ratios.h"

namespace lowlap {

Result<SimulatedProblem> SimulateProblem(const RobustnessLevel& level,
                                         std::uint64_t seed,
                                         const RunContext& context) {
  SyntheticOptions options = level.scene;
  options.seed = seed;
  auto synthetic = Simulate(options);
  if (!synthetic) return tl::unexpected<Error>(synthetic.error());
  Scene& scene = synthetic->scene;
  if (level.has_features) {
    auto ratios = EstimateScaleRatios(scene, level.scale, context);
    if (!ratios) return tl::unexpected<Error>(ratios.error());
    scene.scale_ratios = std::move(*ratios);
  } else {
    SimulatedRatioOptions ratios = level.ratios;
    ratios.seed = seed;
    const Status drawn = SimulateRatios(ratios, &*synthetic);
    if (!drawn) return tl::unexpected<Error>(drawn.error());
  }
  std::map<ViewId, Mat3> rotations;
  std::vector<ViewPair> excluded;
  if (level.averages_rotations) {
    auto averaged = AverageSceneRotations(scene, PoseOptions(), context);
    if (!averaged) return tl::unexpected<Error>(averaged.error());
    rotations = std::move(averaged->cam_from_world);
    for (const OutlierEdge& edge : averaged->outliers) {
      excluded.push_back(edge.views);
    }
  } else {
    for (const auto& [view, pose] : synthetic->true_poses) {
      rotations[view] = pose.rotation;
    }
  }
  SimulatedProblem made;
  made.problem =
      MakeTranslationProblem(scene, rotations, excluded, {}, level.HasTracks());
  Mat3 sum = Mat3::Zero();
  for (const auto& [view, rotation] : rotations) {
    sum += synthetic->true_poses.at(view).rotation.transpose() * rotation;
    made.true_centers.push_back(synthetic->true_poses.at(view).center);
  }
  made.truth_from_solved = NearestRotation(sum);
  return made;
}

}  // namespace lowlap
