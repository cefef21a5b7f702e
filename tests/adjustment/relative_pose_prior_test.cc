#include "lowlap/adjustment/internal/costs/relative_pose_prior.h"

#include <gtest/gtest.h>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

// A solved chain whose relative poses are true and state a covariance.
SyntheticScene SolvedChain() {
  SyntheticOptions options;
  options.num_views = 5;
  options.pairs = "chain";
  SyntheticScene synthetic = *Simulate(options);
  synthetic.scene = TrueSolution(synthetic);
  for (auto& [views, pose] : synthetic.scene.relative_poses) {
    pose.covariance = 1e-6 * Eigen::Matrix<double, 5, 5>::Identity();
  }
  return synthetic;
}

double NormOf(const RelativePosePrior& prior, const CameraSet& cameras) {
  const auto& a = cameras.poses[prior.first];
  const auto& b = cameras.poses[prior.second];
  Eigen::Matrix<double, 5, 1> residual;
  const double* const blocks[] = {
      a.cam_from_world.coeffs().data(), a.center.data(),
      b.cam_from_world.coeffs().data(), b.center.data()};
  EXPECT_TRUE(RelativePoseCost(prior.measured)
                  .Evaluate(blocks, residual.data(), nullptr));
  return residual.norm();
}

TEST(RelativePosePrior, IsZeroAtTheTruthAndCountsDeviations) {
  SyntheticScene synthetic = SolvedChain();
  CameraSet cameras(synthetic.scene);
  const auto priors = LoadRelativePosePriors(synthetic.scene, cameras);
  ASSERT_EQ(priors.size(), 4u);
  for (const RelativePosePrior& prior : priors) {
    EXPECT_LT(NormOf(prior, cameras), 1e-6);
  }
  // A turn of the last view by one degree; 0.1 degrees is the floor.
  auto& last = cameras.poses[priors.back().second];
  last.cam_from_world =
      Eigen::Quaterniond(RotationFromAngleAxis(Vec3(RadFromDeg(1), 0, 0))) *
      last.cam_from_world;
  const double norm = NormOf(priors.back(), cameras);
  EXPECT_GT(norm, 8);
  EXPECT_LT(norm, 12);
}

TEST(RelativePosePrior, LeavesOutWhatIsFalseOrStatesNothing) {
  SyntheticScene synthetic = SolvedChain();
  auto pose = synthetic.scene.relative_poses.begin();
  pose->second.rotation =
      RotationFromAngleAxis(Vec3(0.5, 0, 0)) * pose->second.rotation;
  std::next(pose)->second.covariance.reset();
  const CameraSet cameras(synthetic.scene);
  EXPECT_EQ(LoadRelativePosePriors(synthetic.scene, cameras).size(), 2u);
}

TEST(RelativePosePrior, HoldsTheRotationsOfAThinScene) {
  // Few noisy points, and relative poses that are better than they.
  SyntheticScene synthetic = SolvedChain();
  Scene& scene = synthetic.scene;
  std::size_t n = 0;
  for (auto track = scene.structure.begin(); track != scene.structure.end();) {
    track = n++ % 12 == 0 ? std::next(track) : scene.structure.erase(track);
  }
  scene.line_structure.clear();
  scene.coplanar_pairs.clear();
  scene.line_tracks.clear();
  lowlap::Random random(3);
  for (auto& [id, landmark] : scene.structure) {
    for (auto& observation : landmark.observations) {
      observation.pixel_px += testing::GaussianVec2(random, 2);
      scene.features[observation.view].points_px[observation.feature] =
          observation.pixel_px;
    }
  }
  for (auto track = scene.point_tracks.begin();
       track != scene.point_tracks.end();) {
    track = scene.structure.count(track->first) > 0
                ? std::next(track)
                : scene.point_tracks.erase(track);
  }
  AdjustmentOptions options;
  options.max_outlier_rounds = 0;
  Scene without = scene;
  ASSERT_TRUE(AdjustScene(&scene, options, RunContext()));
  options.use_relative_poses = false;
  ASSERT_TRUE(AdjustScene(&without, options, RunContext()));
  const auto& truth = synthetic.true_poses;
  EXPECT_LT(EvaluatePoses(scene, truth).rotation_deg.mean,
            0.5 * EvaluatePoses(without, truth).rotation_deg.mean);
}

}  // namespace
}  // namespace lowlap
