#include "lowlap/adjustment/bundle_adjuster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lowlap/geometry/internal/rotation.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::BuildAndAdjust;
using test::ComparePoses;
using test::MakeTestScene;
using test::PoseErrors;
using test::TestScene;
using test::TestSceneOptions;
using testing::IsError;
using testing::IsOk;

// Largest distance of corresponding centres, points and line ends.
double Difference(const Scene& a, const Scene& b) {
  double largest = 0;
  for (const auto& [id, pose] : a.poses) {
    largest = std::max(largest, (pose.center - b.poses.at(id).center).norm());
    largest =
        std::max(largest, (pose.rotation - b.poses.at(id).rotation).norm());
  }
  EXPECT_EQ(a.structure.size(), b.structure.size());
  for (const auto& [id, landmark] : a.structure) {
    if (b.structure.count(id) == 0) continue;
    largest = std::max(
        largest, (landmark.position - b.structure.at(id).position).norm());
  }
  EXPECT_EQ(a.line_structure.size(), b.line_structure.size());
  for (const auto& [id, line] : a.line_structure) {
    if (b.line_structure.count(id) == 0) continue;
    largest =
        std::max(largest, (line.start - b.line_structure.at(id).start).norm());
  }
  return largest;
}

TEST(BundleAdjusterTest, ExactDataStaysWhereItIs) {
  TestScene test = MakeTestScene({});
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  for (const auto& [id, pose] : test.true_poses) {
    EXPECT_LT((test.scene.poses.at(id).center - pose.center).norm(), 1e-9);
    EXPECT_LT(
        RotationAngleBetween(test.scene.poses.at(id).rotation, pose.rotation),
        1e-9);
  }
  for (const auto& [id, landmark] : test.scene.structure) {
    EXPECT_LT((landmark.position - test.true_points.at(id)).norm(), 1e-6);
  }
  EXPECT_LT(summary.points.final_rmse_px, 1e-6);
  EXPECT_LT(summary.lines.final_rmse_px, 1e-6);
  EXPECT_EQ(summary.points.observations_dropped, 0u);
  EXPECT_EQ(summary.poses_adjusted, 6u);
  EXPECT_EQ(summary.components, 1u);
  EXPECT_TRUE(summary.converged);
}

TEST(BundleAdjusterTest, PerturbedPosesComeBackWithoutNoise) {
  TestScene test = MakeTestScene({});
  test::PerturbPoses(0.01, 0.05, 5, &test.scene);
  ASSERT_GT(ComparePoses(test.true_poses, test.scene).mean_center, 0.02);
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  const PoseErrors errors = ComparePoses(test.true_poses, test.scene);
  EXPECT_LT(errors.max_center, 1e-6);
  EXPECT_LT(errors.max_rotation_rad, 1e-6);
  EXPECT_LT(summary.final_cost, 1e-6 * summary.initial_cost);
}

TEST(BundleAdjusterTest, NoiseEndsAtItsExpectedLevel) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.01, 0.05, 5, &test.scene);
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  const PoseErrors errors = ComparePoses(test.true_poses, test.scene);
  EXPECT_LT(errors.mean_center, 0.004);
  EXPECT_LT(errors.max_rotation_rad, 0.001);
  EXPECT_NEAR(summary.points.stddev_px, 0.5, 0.1);
  EXPECT_NEAR(summary.lines.stddev_px, 0.5, 0.15);
  // 2 m measurements and 3 unknowns per point of 2 to 6 views.
  EXPECT_GT(summary.points.final_rmse_px, 0.45);
  EXPECT_LT(summary.points.final_rmse_px, 0.5 * std::sqrt(2.0));
}

TEST(BundleAdjusterTest, OutliersAreRemoved) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  options.point_outliers = 0.2;
  options.line_outliers = 0.1;
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.005);
  const std::set<FeatureRef> outliers(test.outlier_points.begin(),
                                      test.outlier_points.end());
  std::size_t wrong = 0;
  for (const auto& [id, landmark] : test.scene.structure) {
    for (const PointObservation& observation : landmark.observations) {
      wrong += outliers.count({observation.view, observation.feature});
    }
  }
  EXPECT_LT(wrong, 0.01 * summary.points.observations_used);
  EXPECT_GE(summary.points.observations_dropped + wrong, outliers.size());
  std::size_t total = 0;
  for (const auto& [id, track] : test.scene.point_tracks) total += track.size();
  EXPECT_EQ(
      summary.points.observations_used + summary.points.observations_dropped,
      total);
  EXPECT_GT(summary.points.observations_used, 0.93 * (total - outliers.size()));
}

TEST(BundleAdjusterTest, ObservationsThatFitAgainCompleteTheirTracks) {
  TestSceneOptions options;
  options.noise_px = 0.3;
  TestScene test = MakeTestScene(options);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  std::size_t removed = 0;
  for (auto& [id, landmark] : test.scene.structure) {
    if (landmark.observations.size() > 3) {
      landmark.observations.pop_back();
      ++removed;
    }
  }
  test.scene.structure.erase(test.scene.structure.begin());
  ASSERT_GT(removed, 50u);
  const Result<AdjustmentSummary> summary = AdjustScene(&test.scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  std::size_t total = 0;
  for (const auto& [id, track] : test.scene.point_tracks) total += track.size();
  EXPECT_GT(summary->points.observations_used, 0.97 * total);
  EXPECT_EQ(summary->landmarks_added, 1u);
}

TEST(BundleAdjusterTest, PointsOnlyAndLinesOnly) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  for (const bool points : {true, false}) {
    SCOPED_TRACE(points ? "points" : "lines");
    TestSceneOptions kind = options;
    (points ? kind.num_lines : kind.num_points) = 0;
    TestScene test = MakeTestScene(kind);
    test::PerturbPoses(0.005, 0.03, 5, &test.scene);
    const PoseErrors before = ComparePoses(test.true_poses, test.scene);
    BuildAndAdjust(&test.scene);
    const PoseErrors after = ComparePoses(test.true_poses, test.scene);
    EXPECT_LT(after.mean_center, 0.3 * before.mean_center);
    EXPECT_LT(after.mean_center, points ? 0.004 : 0.008);
  }
}

TEST(BundleAdjusterTest, KindsThatAreOffFollowThePoses) {
  TestSceneOptions options;
  options.noise_px = 0.3;
  for (const bool points : {true, false}) {
    SCOPED_TRACE(points ? "points off" : "lines off");
    TestScene test = MakeTestScene(options);
    test::PerturbPoses(0.005, 0.03, 5, &test.scene);
    AdjustmentOptions adjustment;
    (points ? adjustment.use_points : adjustment.use_lines) = false;
    const AdjustmentSummary summary = BuildAndAdjust(&test.scene, adjustment);
    EXPECT_LT(summary.points.final_rmse_px, 1);
    EXPECT_LT(summary.lines.final_rmse_px, 1);
    EXPECT_GT(test.scene.structure.size(), 0.9 * test.true_points.size());
    EXPECT_GT(test.scene.line_structure.size(), 0.85 * test.true_lines.size());
  }
}

TEST(BundleAdjusterTest, BadLinesDoNotSpoilGoodPoints) {
  TestSceneOptions options;
  options.noise_px = 0.3;
  double with_lines = 0, without = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    options.seed = seed;
    TestScene test = MakeTestScene(options);
    // Lines of ten times the noise that the others have, undeclared.
    for (auto& [view, features] : test.scene.features) {
      int n = 0;
      for (LineSegment& segment : features.segments) {
        const double shift = (n++ % 2 == 0 ? 3 : -3);
        segment.start_px.y() += shift;
        segment.end_px.x() -= shift;
      }
    }
    test::PerturbPoses(0.005, 0.03, 5 + seed, &test.scene);
    Scene points_only = test.scene;
    AdjustmentOptions no_lines;
    no_lines.use_lines = false;
    BuildAndAdjust(&test.scene);
    BuildAndAdjust(&points_only, no_lines);
    with_lines += ComparePoses(test.true_poses, test.scene).mean_center;
    without += ComparePoses(test.true_poses, points_only).mean_center;
  }
  EXPECT_LT(with_lines, 1.1 * without);
}

TEST(BundleAdjusterTest, EquivariantToSimilarities) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  options.point_outliers = 0.05;
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  const Similarity similarity{
      37.0, RotationFromAngleAxis({0.7, -1.1, 0.4}), {500, -80, 3000}};
  Scene moved = test::Transformed(test.scene, similarity);
  ASSERT_THAT(AdjustScene(&test.scene, {}, {}), IsOk());
  ASSERT_THAT(AdjustScene(&moved, {}, {}), IsOk());
  const Scene back = test::Transformed(moved, similarity.Inverse());
  EXPECT_LT(Difference(test.scene, back), 1e-5);
}

TEST(BundleAdjusterTest, TheReferencePoseIsHeld) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  const std::map<PoseId, Pose> before = test.scene.poses;
  BuildAndAdjust(&test.scene);
  int held = 0;
  for (const auto& [id, pose] : before) {
    held += (pose.center - test.scene.poses.at(id).center).norm() < 1e-12;
  }
  EXPECT_EQ(held, 1);
}

TEST(BundleAdjusterTest, SameBytesForAnyNumberOfThreads) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  options.point_outliers = 0.1;
  options.line_outliers = 0.1;
  options.max_line_views = 3;
  options.pairs_per_triplet = 20;
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  Scene one = test.scene, many = test.scene;
  RunContext context;
  context.num_threads = 1;
  ASSERT_THAT(AdjustScene(&one, {}, context), IsOk());
  context.num_threads = 4;
  ASSERT_THAT(AdjustScene(&many, {}, context), IsOk());
  EXPECT_TRUE(one == many);
}

TEST(BundleAdjusterTest, FocalLengthsAndDistortionAreRefinedOnRequest) {
  TestSceneOptions options;
  options.noise_px = 0.2;
  options.model = CameraModel::kRadialK1;
  options.distortion = {-0.08};
  TestScene test = MakeTestScene(options);
  const Intrinsic truth = test.scene.intrinsics.at(7);
  Intrinsic& intrinsic = test.scene.intrinsics.at(7);
  intrinsic.fx_px *= 1.01;
  intrinsic.fy_px *= 0.99;
  intrinsic.distortion[0] = -0.06;
  const Intrinsic start = intrinsic;
  Scene fixed = test.scene;
  AdjustmentOptions refine;
  refine.refine_intrinsics[7] = {true, false, true, true};
  BuildAndAdjust(&test.scene, refine);
  EXPECT_NEAR(intrinsic.fx_px, truth.fx_px, 2);
  EXPECT_NEAR(intrinsic.fy_px, truth.fy_px, 2);
  EXPECT_NEAR(intrinsic.distortion[0], truth.distortion[0], 0.005);
  EXPECT_EQ(intrinsic.principal_point_px, truth.principal_point_px);
  AdjustmentOptions exact;
  exact.principal_point_stddev = 0;
  BuildAndAdjust(&fixed, exact);
  EXPECT_TRUE(fixed.intrinsics.at(7) == start);
}

TEST(BundleAdjusterTest, DistortedViewsWithFixedIntrinsics) {
  for (const auto& [model, distortion] :
       {std::pair(CameraModel::kBrownT2,
                  std::vector<double>{-0.1, 0.03, -0.004, 0.001, -0.002}),
        std::pair(CameraModel::kFisheye,
                  std::vector<double>{0.02, -0.01, 0.003, -0.0005}),
        std::pair(CameraModel::kSpherical, std::vector<double>{})}) {
    SCOPED_TRACE(CameraModelName(model));
    TestSceneOptions options;
    options.model = model;
    options.distortion = distortion;
    TestScene test = MakeTestScene(options);
    test::PerturbPoses(0.005, 0.03, 5, &test.scene);
    BuildAndAdjust(&test.scene);
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).max_center, 1e-5);
  }
}

TEST(BundleAdjusterTest, SummaryTellsEverySolve) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  options.point_outliers = 0.05;
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  ASSERT_GE(summary.solves.size(), 3u);
  EXPECT_EQ(summary.solves[0].stage, "fixed rotations");
  EXPECT_EQ(summary.solves[1].stage, "everything");
  EXPECT_EQ(summary.solves.back().stage, "final");
  int iterations = 0;
  for (const SolveReport& report : summary.solves) {
    EXPECT_LE(report.final_cost, report.initial_cost);
    EXPECT_GT(report.residuals, report.parameters);
    iterations += report.iterations;
  }
  EXPECT_EQ(summary.iterations, iterations);
  EXPECT_EQ(summary.initial_cost, summary.solves.front().initial_cost);
  EXPECT_EQ(summary.final_cost, summary.solves.back().final_cost);
}

// Of the distances in the photographs, whatever weighs the errors.
TEST(BundleAdjusterTest, TheRmseHasNoWeights) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  TestScene test = MakeTestScene(options);
  test.scene.intrinsics.at(7).fy_px = 800;
  for (auto& [view, features] : test.scene.features) {
    for (std::size_t n = 0; n < features.segments.size(); ++n) {
      features.segments[n].stddev_px = n % 2 == 0 ? 0.3 : 1.2;
    }
    features.point_covariances.assign(features.points_px.size(), Vec3(9, 0, 1));
  }
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  const Scene& scene = test.scene;
  const Intrinsic& intrinsic = scene.intrinsics.at(7);
  double points = 0, ends = 0;
  for (const auto& [id, landmark] : scene.structure) {
    for (const PointObservation& seen : landmark.observations) {
      points += (intrinsic.Project(scene.FindPose(seen.view)->CamFromWorld() *
                                   landmark.position) -
                 seen.pixel_px)
                    .squaredNorm();
    }
  }
  for (const auto& [id, line] : scene.line_structure) {
    for (const FeatureRef& seen : line.observations) {
      const LineSegment& segment =
          scene.features.at(seen.view).segments[seen.feature];
      const Vec3 normal =
          (scene.FindPose(seen.view)->CamFromWorld() * line.line).moment;
      for (const Vec2& end_px : {segment.start_px, segment.end_px}) {
        const double distance =
            intrinsic.Normalize(end_px)->homogeneous().dot(normal) /
            normal.head<2>().norm();
        ends += std::pow(intrinsic.fx_px * distance, 2);
      }
    }
  }
  ASSERT_TRUE(summary.points.final_rmse_px && summary.lines.final_rmse_px);
  EXPECT_NEAR(
      *summary.points.final_rmse_px,
      std::sqrt(points / static_cast<double>(summary.points.observations_used)),
      1e-6);
  EXPECT_NEAR(*summary.lines.final_rmse_px,
              std::sqrt(ends / (2.0 * static_cast<double>(
                                          summary.lines.observations_used))),
              1e-6);
  EXPECT_FALSE(summary.coplanar.final_rmse_px);
}

}  // namespace
}  // namespace lowlap
