#include "lowlap/pipeline/translation_scale_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/matching/internal/tracks.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

enum class Order { kAscending, kDescending };

Eigen::Matrix2Xi Columns(const std::vector<FeatureMatch>& matches,
                         Order order) {
  Eigen::Matrix2Xi columns(2, matches.size());
  for (std::size_t n = 0; n < matches.size(); ++n) {
    columns(0, n) = static_cast<int>(matches[n].first);
    columns(1, n) = static_cast<int>(matches[n].second);
  }
  if (order == Order::kDescending) columns.row(0).swap(columns.row(1));
  return columns;
}

Eigen::Matrix2Xd Points(const ViewFeatures& features) {
  Eigen::Matrix2Xd points(2, features.points_px.size());
  for (std::size_t n = 0; n < features.points_px.size(); ++n) {
    points.col(n) = features.points_px[n];
  }
  return points;
}

Eigen::Matrix4Xd Segments(const ViewFeatures& features) {
  Eigen::Matrix4Xd segments(4, features.segments.size());
  for (std::size_t n = 0; n < features.segments.size(); ++n) {
    segments.col(n) << features.segments[n].start_px,
        features.segments[n].end_px;
  }
  return segments;
}

void AddView(const Scene& scene, ViewId view,
             TranslationScaleEstimator* estimator) {
  const ViewFeatures& features = scene.features.at(view);
  estimator->AddView(view, *scene.FindIntrinsic(view), Points(features),
                     Segments(features));
}

void AddPose(const RelativePose& pose, Order order,
             TranslationScaleEstimator* estimator) {
  RigidTransform transform{pose.rotation, 3.0 * pose.direction};
  std::pair<ViewId, ViewId> views{pose.views.first, pose.views.second};
  if (order == Order::kDescending) {
    transform = transform.Inverse();
    std::swap(views.first, views.second);
  }
  estimator->AddRelativePose(
      views.first, views.second, transform.rotation, transform.translation,
      Columns(pose.point_inliers, order), Columns(pose.line_inliers, order));
}

TranslationScaleEstimator HostOf(const Scene& scene, Order order) {
  TranslationScaleEstimator estimator;
  for (const auto& [views, pose] : scene.relative_poses) {
    AddPose(pose, order, &estimator);
  }
  for (const auto& entry : scene.views) AddView(scene, entry.first, &estimator);
  return estimator;
}

// A chain of views of which no three see the same feature.
SyntheticScene Chain() {
  SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "chain";
  options.trifocal_point_share = options.trifocal_line_share = 0;
  return *Simulate(options);
}

TEST(TranslationScaleEstimator, FindsScalesOfAChainWithoutTrifocalFeatures) {
  const SyntheticScene chain = Chain();
  for (const Order order : {Order::kAscending, Order::kDescending}) {
    const auto estimate = HostOf(chain.scene, order).Estimate();
    ASSERT_THAT(estimate, IsOk());
    ASSERT_EQ(estimate->ratios.size(), 4u);
    for (const ScaleRatio& ratio : estimate->ratios) {
      EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
      const double true_log_ratio = *chain.TrueLogRatio(ratio.views);
      EXPECT_GE(true_log_ratio, ratio.IntervalLow());
      EXPECT_LE(true_log_ratio, ratio.IntervalHigh());
      // A chain has no more ratios than it needs, so its centres follow them.
      const auto distance = [&](ViewId a, ViewId b) {
        return (estimate->poses.at(a).center - estimate->poses.at(b).center)
            .norm();
      };
      EXPECT_NEAR(std::log(distance(ratio.views.middle, ratio.views.last) /
                           distance(ratio.views.first, ratio.views.middle)),
                  ratio.log_ratio, 1e-9);
    }
    EXPECT_TRUE(estimate->unplaced.empty());
    EXPECT_EQ(estimate->poses.size(), 6u);
  }
}

TEST(TranslationScaleEstimator, IsTheFirstHalfOfSolveScene) {
  const SyntheticScene chain = Chain();
  const auto estimate = HostOf(chain.scene, Order::kAscending).Estimate();
  ASSERT_THAT(estimate, IsOk());
  Scene scene = chain.scene;
  SolveOptions options;
  options.adjust = false;
  ASSERT_THAT(SolveScene(&scene, options, {}, nullptr), IsOk());
  for (const auto& [view, pose] : estimate->poses) {
    EXPECT_THAT(pose, testing::PoseNear(*scene.FindPose(view), 1e-6, 1e-6));
  }
}

TEST(TranslationScaleEstimator, JoinsThePiecesOfBrokenLines) {
  SyntheticOptions options;
  options.num_views = 4;
  options.pairs = "chain";
  options.trifocal_point_share = 0;
  options.broken_line_share = 0.5;
  const SyntheticScene broken = *Simulate(options);
  const auto estimate = HostOf(broken.scene, Order::kAscending).Estimate();
  ASSERT_THAT(estimate, IsOk());
  Scene scene = broken.scene;
  scene.line_tracks = BuildLineTracks(scene, {});
  const auto joined = *EstimateScaleRatios(scene, {}, {});
  scene.line_tracks.clear();
  const auto apart = *EstimateScaleRatios(scene, {}, {});
  ASSERT_EQ(estimate->ratios.size(), joined.size());
  for (std::size_t n = 0; n < joined.size(); ++n) {
    const auto candidates = [](const ScaleRatio& ratio) {
      return ratio.FindKind("coplanar")->candidates;
    };
    EXPECT_NEAR(estimate->ratios[n].log_ratio, joined[n].log_ratio, 1e-9);
    EXPECT_EQ(candidates(estimate->ratios[n]), candidates(joined[n]));
    EXPECT_LT(candidates(joined[n]), candidates(apart[n]));
  }
}

TEST(TranslationScaleEstimator, ACalibrationMatrixIsACameraWithoutDistortion) {
  const SyntheticScene chain = Chain();
  TranslationScaleEstimator estimator;
  for (const auto& [views, pose] : chain.scene.relative_poses) {
    AddPose(pose, Order::kAscending, &estimator);
  }
  for (const auto& entry : chain.scene.views) {
    const Intrinsic& intrinsic = *chain.scene.FindIntrinsic(entry.first);
    Mat3 calibration_px = Mat3::Identity();
    calibration_px(0, 0) = intrinsic.fx_px;
    calibration_px(1, 1) = intrinsic.fy_px;
    calibration_px.topRightCorner<2, 1>() = intrinsic.principal_point_px;
    const ViewFeatures& features = chain.scene.features.at(entry.first);
    estimator.AddView(entry.first, calibration_px, intrinsic.width_px,
                      intrinsic.height_px, Points(features),
                      Segments(features));
  }
  const auto estimate = estimator.Estimate();
  const auto expected = HostOf(chain.scene, Order::kAscending).Estimate();
  ASSERT_THAT(estimate, IsOk());
  ASSERT_THAT(expected, IsOk());
  EXPECT_EQ(estimate->ratios, expected->ratios);
  EXPECT_EQ(estimate->poses, expected->poses);
}

TEST(TranslationScaleEstimator, KeepsTheRotationsOfTheHost) {
  const SyntheticScene chain = Chain();
  TranslationScaleEstimator estimator = HostOf(chain.scene, Order::kAscending);
  for (const auto& [view, pose] : chain.true_poses) {
    estimator.SetRotation(view, pose.rotation);
  }
  const auto estimate = estimator.Estimate();
  ASSERT_THAT(estimate, IsOk());
  ASSERT_EQ(estimate->poses.size(), 6u);
  // Without noise the averaged rotations are the same, in another frame.
  const auto averaged = HostOf(chain.scene, Order::kAscending).Estimate();
  ASSERT_THAT(averaged, IsOk());
  const Mat3 first_cam_from_world = chain.true_poses.at(0).rotation;
  for (const auto& [view, pose] : averaged->poses) {
    EXPECT_THAT(first_cam_from_world * estimate->poses.at(view).center,
                testing::VectorNear(pose.center, 1e-9));
  }
  for (const auto& [view, pose] : estimate->poses) {
    EXPECT_EQ(pose.rotation, chain.true_poses.at(view).rotation);
  }
}

TEST(TranslationScaleEstimator, LeavesOutWhatContradictsGivenRotations) {
  SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "window:2";
  const SyntheticScene truth = *Simulate(options);
  Scene scene = truth.scene;
  RelativePose& wrong = scene.relative_poses.at({1, 2});
  wrong.rotation = RotationFromAngleAxis({0, 0.2, 0}) * wrong.rotation;
  TranslationScaleEstimator estimator = HostOf(scene, Order::kAscending);
  for (const auto& [view, pose] : truth.true_poses) {
    estimator.SetRotation(view, pose.rotation);
  }
  const auto estimate = estimator.Estimate();
  ASSERT_THAT(estimate, IsOk());
  ASSERT_EQ(estimate->summary.outlier_edges.size(), 1u);
  EXPECT_EQ(estimate->summary.outlier_edges[0].views, (ViewPair{1, 2}));
  EXPECT_EQ(estimate->summary.outlier_edges[0].reason,
            OutlierReason::kRotation);
  EXPECT_NEAR(estimate->summary.outlier_edges[0].error_deg, DegFromRad(0.2),
              1e-3);
  EXPECT_TRUE(estimate->unplaced.empty());
}

TEST(TranslationScaleEstimator, EstimatesAsOftenAsAsked) {
  const TranslationScaleEstimator estimator =
      HostOf(Chain().scene, Order::kAscending);
  const auto first = estimator.Estimate();
  const auto second = estimator.Estimate();
  ASSERT_THAT(first, IsOk());
  ASSERT_THAT(second, IsOk());
  EXPECT_EQ(first->ratios, second->ratios);
  EXPECT_EQ(first->poses, second->poses);
}

TEST(TranslationScaleEstimator, NamesWhatIsWrong) {
  const SyntheticScene chain = Chain();
  const auto host = [&] { return HostOf(chain.scene, Order::kAscending); };
  const RelativePose& pose = chain.scene.relative_poses.begin()->second;

  TranslationScaleEstimator twice = host();
  AddView(chain.scene, 2, &twice);
  EXPECT_THAT(twice.Estimate(),
              IsError(ErrorCode::kInvalidScene, "view 2 is given twice"));

  TranslationScaleEstimator pose_twice = host();
  AddPose(pose, Order::kDescending, &pose_twice);
  EXPECT_THAT(pose_twice.Estimate(),
              IsError(ErrorCode::kInvalidScene,
                      "relative pose of view 1 and view 0 is given twice"));

  TranslationScaleEstimator unknown = host();
  unknown.AddRelativePose(0, 17, pose.rotation, pose.direction, {});
  EXPECT_THAT(unknown.Estimate(),
              IsError(ErrorCode::kInvalidScene, "there is no view 17"));

  TranslationScaleEstimator still = host();
  still.AddRelativePose(0, 2, pose.rotation, Vec3::Zero(), {});
  EXPECT_THAT(still.Estimate(),
              IsError(ErrorCode::kInvalidScene, "has no direction"));

  TranslationScaleEstimator skewed = host();
  Mat3 calibration = 900 * Mat3::Identity();
  calibration(0, 1) = 1;
  calibration(2, 2) = 1;
  skewed.AddView(17, calibration, 1200, 900, {});
  EXPECT_THAT(skewed.Estimate(),
              IsError(ErrorCode::kInvalidScene, "view 17: a calibration"));

  TranslationScaleEstimator some = host();
  some.SetRotation(3, Mat3::Identity());
  EXPECT_THAT(some.Estimate(),
              IsError(ErrorCode::kInvalidScene, "1 of 6 views"));
}

TEST(TranslationScaleEstimator, CancelsWhenAsked) {
  RunContext context;
  context.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  EXPECT_THAT(HostOf(Chain().scene, Order::kAscending).Estimate(context),
              IsError(ErrorCode::kCancelled, ""));
}

}  // namespace
}  // namespace lowlap
