#include "lowlap/study/internal/consistency.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

Scene TruthOfARoom() {
  SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "window:2";
  Scene scene = TrueSolution(*Simulate(options));
  for (ScaleRatio& ratio : scene.scale_ratios) {
    ratio.verdict = RatioVerdict::kMeaningful;
  }
  return scene;
}

TEST(Consistency, TheTruthAgreesWithExactMeasurements) {
  const Scene scene = TruthOfARoom();
  ASSERT_FALSE(scene.scale_ratios.empty());
  const Consistency consistency = EvaluateConsistency(scene, {});
  EXPECT_EQ(consistency.direction_deg.count,
            static_cast<int>(scene.relative_poses.size()));
  EXPECT_LT(consistency.direction_deg.max, 1e-4);
  EXPECT_EQ(consistency.abs_log_ratio.count,
            static_cast<int>(scene.scale_ratios.size()));
  EXPECT_LT(consistency.abs_log_ratio.max, 1e-9);
  EXPECT_EQ(consistency.num_points, scene.structure.size());
  EXPECT_LT(consistency.reprojection_rmse_px, 1e-6);
  EXPECT_GT(consistency.mean_baseline, 0);
}

TEST(Consistency, ScaleChangesTheBaselinesOnly) {
  Scene scene = TruthOfARoom();
  const double baseline = EvaluateConsistency(scene, {}).mean_baseline;
  for (auto& [id, pose] : scene.poses) pose.center *= 3;
  for (auto& [id, landmark] : scene.structure) landmark.position *= 3;
  const Consistency scaled = EvaluateConsistency(scene, {});
  EXPECT_NEAR(scaled.mean_baseline, 3 * baseline, 1e-9);
  EXPECT_LT(scaled.direction_deg.max, 1e-4);
  EXPECT_LT(scaled.reprojection_rmse_px, 1e-6);
}

TEST(Consistency, AWrongDirectionShowsUnlessItIsAnOutlier) {
  Scene scene = TruthOfARoom();
  auto& [views, pose] = *scene.relative_poses.begin();
  Vec3 axis = pose.direction.unitOrthogonal();
  pose.direction = Eigen::AngleAxisd(RadFromDeg(20), axis) * pose.direction;
  EXPECT_NEAR(EvaluateConsistency(scene, {}).direction_deg.max, 20, 1e-6);
  const Consistency without = EvaluateConsistency(scene, {views});
  EXPECT_LT(without.direction_deg.max, 1e-4);
  EXPECT_EQ(without.direction_deg.count,
            static_cast<int>(scene.relative_poses.size()) - 1);
}

// Two parts of a chain at an arbitrary common scale: every direction fits.
TEST(Consistency, AnArbitraryScaleShowsInTheRatiosAlone) {
  SyntheticOptions options;
  options.num_views = 5;
  options.pairs = "chain";
  Scene scene = TrueSolution(*Simulate(options));
  for (ScaleRatio& ratio : scene.scale_ratios) {
    ratio.verdict = RatioVerdict::kMeaningful;
  }
  const Vec3 hinge = scene.FindPose(2)->center;
  for (const ViewId view : {3, 4}) {
    Pose& pose = scene.poses.at(scene.views.at(view).pose_id);
    pose.center = hinge + 2 * (pose.center - hinge);
  }
  const Consistency consistency = EvaluateConsistency(scene, {});
  EXPECT_LT(consistency.direction_deg.max, 1e-4);
  EXPECT_NEAR(consistency.abs_log_ratio.max, std::log(2.0), 1e-9);
}

TEST(Consistency, MissingCamerasAndCoincidingCentres) {
  Scene scene = TruthOfARoom();
  scene.poses.at(scene.views.at(1).pose_id).center = scene.FindPose(0)->center;
  EXPECT_EQ(EvaluateConsistency(scene, {}).direction_deg.max, 90);
  scene.poses.clear();
  const Consistency nothing = EvaluateConsistency(scene, {});
  EXPECT_EQ(nothing.direction_deg.count, 0);
  EXPECT_EQ(nothing.abs_log_ratio.count, 0);
  EXPECT_EQ(nothing.reprojection_rmse_px, 0);
}

TEST(Consistency, ErrorsInAPanoramaGoTheShortWayRound) {
  Scene scene;
  Intrinsic& panorama = scene.intrinsics[0];
  panorama.model = CameraModel::kSpherical;
  panorama.width_px = 1000;
  panorama.height_px = 500;
  scene.views[0].intrinsic_id = 0;
  scene.views[0].pose_id = 0;
  scene.poses[0] = Pose();
  // Behind the camera is the seam, at 0 and at 1000 px.
  const Vec3 behind(0.001, 0, -1);
  const Vec2 pixel_px = panorama.Project(behind) + Vec2(0.5 - 1000, 0);
  scene.structure[0] = {behind, {{0, 0, pixel_px}}};
  EXPECT_NEAR(EvaluateConsistency(scene, {}).reprojection_rmse_px, 0.5, 1e-9);
}

}  // namespace
}  // namespace lowlap
