// Aligned points obey the true epipolar geometry better than detected ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/core/internal/median.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/image_measurements.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/scene/features.h"
#include "support/data_folder.h"
#include "support/matchers.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

using testing::IsOk;

// Sampson distances of all point inliers under the true poses.
std::vector<double> TrueResidualsPx(const Scene& scene,
                                    const GroundTruth& truth) {
  std::vector<double> residuals_px;
  for (const auto& [views, pose] : scene.relative_poses) {
    const RigidTransform cam2_from_cam1 =
        truth.at(views.second).CamFromWorld() *
        truth.at(views.first).CamFromWorld().Inverse();
    const Mat3 essential = EssentialFromPose(cam2_from_cam1);
    const auto [first, second] = views;
    const NormalizedFeatures features1 = NormalizeFeatures(
        scene.features.at(first), *scene.FindIntrinsic(first));
    const NormalizedFeatures features2 = NormalizeFeatures(
        scene.features.at(second), *scene.FindIntrinsic(second));
    for (const FeatureMatch& match : pose.point_inliers) {
      residuals_px.push_back(
          features1.focal_px *
          std::sqrt(SampsonSquared(essential, features1.points[match.first],
                                   features2.points[match.second])));
    }
  }
  return residuals_px;
}

TEST(RefinePoints, BringsMatchesNearerToTheTrueGeometry) {
  IntrinsicSource source;
  source.calibration =
      *strecha::ReadCalibrationMatrix(RoomFolder() + "/images/K.txt");
  const auto scene = SceneFromImages(RoomFolder() + "/images", source, {});
  ASSERT_THAT(scene, IsOk());
  MeasurementOptions options;
  options.pairs = "chain";
  options.features.tilts.max_tilt = 1;
  StageLog stages;
  const auto measured = MatchImages(*scene, options, RunContext(), &stages);
  ASSERT_THAT(measured, IsOk());
  Scene detected = *scene, refined = *scene, other_threads = *scene;
  ASSERT_THAT(RelatePairs(*measured, options, RunContext(), &stages, &detected),
              IsOk());
  options.refine_points = true;
  const auto reports =
      RelatePairs(*measured, options, RunContext(), &stages, &refined);
  ASSERT_THAT(reports, IsOk());
  for (const PairReport& report : *reports) {
    if (!report.accepted) continue;
    EXPECT_EQ(
        report.num_point_inliers,
        static_cast<int>(
            refined.relative_poses.at(report.views).point_inliers.size()));
  }
  RunContext one;
  one.num_threads = 1;
  ASSERT_THAT(RelatePairs(*measured, options, one, &stages, &other_threads),
              IsOk());
  EXPECT_TRUE(other_threads == refined);

  const auto poses = strecha::ReadGroundTruth(RoomFolder());
  ASSERT_THAT(poses, IsOk());
  const auto truth = GroundTruthByName(*scene, *poses);
  ASSERT_THAT(truth, IsOk());
  const std::vector<double> before = TrueResidualsPx(detected, *truth);
  const std::vector<double> after = TrueResidualsPx(refined, *truth);
  EXPECT_GT(after.size(), 0.95 * before.size());
  std::printf("median residual %.3f px, aligned %.3f px\n", Median(before),
              Median(after));
  EXPECT_LT(Median(after), 0.95 * Median(before));
}

}  // namespace
}  // namespace lowlap
