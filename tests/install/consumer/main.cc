// What an outside program does with the installed package: it simulates a
// scene without noise, solves it, and compares the result with the truth. The
// failed reading of photographs links the image libraries as well.
#include <cstdio>
#include <vector>

#include "lowlap/geometry/similarity.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/validation.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace {

int Fail(const lowlap::Error& error) {
  std::printf("%s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main() {
  lowlap::SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "chain";
  options.trifocal_point_share = options.trifocal_line_share = 0.2;
  const auto synthetic = lowlap::Simulate(options);
  if (!synthetic) return Fail(synthetic.error());
  lowlap::Scene scene = synthetic->scene;
  if (const auto valid = lowlap::ValidateScene(scene); !valid) {
    return Fail(valid.error());
  }
  lowlap::StageLog stages;
  const auto result = lowlap::SolveScene(&scene, {}, {}, &stages);
  if (!result) return Fail(result.error());

  std::vector<lowlap::Vec3> solved, truth;
  for (const auto& [id, true_pose] : synthetic->true_poses) {
    const lowlap::Pose* pose = scene.FindPose(id);
    if (!pose) continue;
    solved.push_back(pose->center);
    truth.push_back(true_pose.center);
  }
  const auto truth_from_solved = lowlap::AlignPoints(solved, truth);
  if (!truth_from_solved) return Fail(truth_from_solved.error());
  double worst = 0;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    const double error = (*truth_from_solved * solved[i] - truth[i]).norm();
    if (error > worst) worst = error;
  }
  std::printf("%zu of 6 cameras, worst position error %.2g m\n", solved.size(),
              worst);
  const bool no_images =
      !lowlap::SceneFromImages("no such folder", {}, {}).has_value();
  return solved.size() == 6 && worst < 1e-4 && no_images ? 0 : 1;
}
