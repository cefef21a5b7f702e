#include "lowlap/scale/triplet_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/scale/scale_ratios.h"
#include "scale/row_of_views.h"

namespace lowlap {
namespace {

using testing::RowOfViews;

TEST(MakeTripletView, ChainsThroughTheFeaturesOfTheMiddleView) {
  const RowOfViews row;
  Scene scene = row.scene;
  scene.relative_poses.at({0, 2}).point_inliers = {{4, 7}, {5, 8}, {6, 9}};
  scene.relative_poses.at({2, 3}).point_inliers = {{9, 1}, {7, 2}, {7, 3}};
  const SceneFeatures features(scene);
  const auto triplet = MakeTripletView(features, {0, 2, 3});
  ASSERT_TRUE(triplet.has_value());
  ASSERT_EQ(triplet->points.size(), 3u);
  EXPECT_EQ(triplet->points[0].point_in_middle, 7u);
  EXPECT_EQ(triplet->points[0].in_i, features.normalized.at(0).points[4]);
  EXPECT_EQ(triplet->points[0].in_k, features.normalized.at(3).points[2]);
  EXPECT_EQ(triplet->points[1].in_k, features.normalized.at(3).points[3]);
  EXPECT_EQ(triplet->points[2].point_in_middle, 9u);
  EXPECT_EQ(triplet->points[2].in_k, features.normalized.at(3).points[1]);
  // The middle view may be the first of an edge.
  const auto reversed = MakeTripletView(features, {2, 0, 1});
  ASSERT_TRUE(reversed.has_value());
  EXPECT_EQ(reversed->points.size(), 3u);
  EXPECT_EQ(reversed->points[0].in_i, features.normalized.at(2).points[7]);
}

// One blob with two orientations is two features of one place.
TEST(MakeTripletView, PointsOfOnePlaceInAllViewsAreOne) {
  Scene scene = RowOfViews().scene;
  for (const ViewId view : {0, 1, 2}) {
    std::vector<Vec2>& points = scene.features.at(view).points_px;
    points[6] = points[5];
  }
  scene.relative_poses.at({0, 1}).point_inliers = {{5, 5}, {6, 6}, {7, 7}};
  scene.relative_poses.at({1, 2}).point_inliers = {{5, 5}, {6, 6}, {7, 7}};
  const auto triplet = MakeTripletView(SceneFeatures(scene), {0, 1, 2});
  ASSERT_TRUE(triplet.has_value());
  ASSERT_EQ(triplet->points.size(), 2u);
  EXPECT_EQ(triplet->points[0].point_in_middle, 5u);
  EXPECT_EQ(triplet->points[1].point_in_middle, 7u);
  // Another place in one view is another match.
  scene.features.at(2).points_px[6].x() += 20;
  EXPECT_EQ(MakeTripletView(SceneFeatures(scene), {0, 1, 2})->points.size(),
            3u);
}

// A line that view 1 breaks into segments 6 and 7, each matched in one pair; 7
// is the longer one. Line 8 is whole.
Scene BrokenInTheMiddle() {
  Scene scene = RowOfViews().scene;
  scene.relative_poses.at({0, 1}).line_inliers = {{5, 6}, {8, 8}};
  scene.relative_poses.at({1, 2}).line_inliers = {{7, 9}, {8, 8}};
  std::vector<LineSegment>& segments = scene.features.at(1).segments;
  segments[6] = {{100, 300}, {200, 300}, 0.1};
  segments[7] = {{300, 300}, {500, 300}, 0.2};
  return scene;
}

TEST(MakeTripletView, SegmentsOfOneTrackAreOneLine) {
  Scene scene = BrokenInTheMiddle();
  scene.line_tracks[3] = {{0, 5}, {1, 6}, {1, 7}, {2, 9}};
  scene.line_tracks[4] = {{0, 8}, {1, 8}, {2, 8}};
  const SceneFeatures features(scene);
  const auto triplet = MakeTripletView(features, {0, 1, 2});
  ASSERT_TRUE(triplet.has_value());
  ASSERT_EQ(triplet->lines.size(), 2u);
  EXPECT_EQ(triplet->lines_ij.size(), 2u);
  EXPECT_EQ(triplet->lines_jk.size(), 2u);
  const TripletLine& broken = triplet->lines[0];
  EXPECT_EQ(broken.segment_in_middle, 7u);
  EXPECT_EQ(broken.in_j.stddev_px, 0.2);
  const auto start = [&](ViewId view, FeatureIndex segment) {
    return features.normalized.at(view).segments[segment].start;
  };
  EXPECT_EQ(broken.in_i.segment.start, start(0, 5));
  EXPECT_EQ(broken.in_j.segment.start, start(1, 7));
  EXPECT_EQ(broken.in_k.segment.start, start(2, 9));
  EXPECT_EQ(triplet->lines_ij[0].segment_in_middle, 7u);
  EXPECT_EQ(triplet->lines_jk[0].segment_in_middle, 7u);
  EXPECT_EQ(triplet->lines[1].segment_in_middle, 8u);
}

TEST(MakeTripletView, SegmentsWithoutATrackAreLinesOfTheirOwn) {
  Scene scene = BrokenInTheMiddle();
  scene.relative_poses.at({0, 1}).line_inliers = {{4, 6}, {5, 6}, {8, 8}};
  scene.features.at(0).segments[4] = {{100, 310}, {450, 310}, 0.3};
  scene.features.at(0).segments[5] = {{500, 310}, {600, 310}, 0.4};
  const auto triplet = MakeTripletView(SceneFeatures(scene), {0, 1, 2});
  ASSERT_TRUE(triplet.has_value());
  ASSERT_EQ(triplet->lines.size(), 1u);
  EXPECT_EQ(triplet->lines[0].segment_in_middle, 8u);
  ASSERT_EQ(triplet->lines_ij.size(), 2u);
  EXPECT_EQ(triplet->lines_ij[0].segment_in_middle, 6u);
  EXPECT_EQ(triplet->lines_ij[0].in_neighbor.stddev_px, 0.3);
  EXPECT_EQ(triplet->lines_jk.size(), 2u);
}

TEST(MakeTripletView, MatchesThatTheTracksRefuseAreLeftOut) {
  Scene scene = BrokenInTheMiddle();
  scene.line_tracks[3] = {{0, 5}, {2, 9}};
  scene.line_tracks[4] = {{0, 8}, {1, 6}, {1, 8}, {2, 8}};
  const auto triplet = MakeTripletView(SceneFeatures(scene), {0, 1, 2});
  ASSERT_TRUE(triplet.has_value());
  // Segment 6 is on another track than 5, and 7 on none.
  for (const auto* lines : {&triplet->lines_ij, &triplet->lines_jk}) {
    ASSERT_EQ(lines->size(), 1u);
    EXPECT_EQ(lines->front().segment_in_middle, 8u);
  }
}

TEST(MakeTripletView, PerturbsThePosesByTheirCovariances) {
  RowOfViews row;
  const SceneFeatures features(row.scene);
  EXPECT_TRUE(MakeTripletView(features, {0, 1, 2})->pose_perturbations.empty());
  row.scene.relative_poses.at({1, 2}).covariance =
      1e-6 * Eigen::Matrix<double, 5, 5>::Identity();
  const auto triplet = MakeTripletView(features, {0, 1, 2});
  ASSERT_EQ(triplet->pose_perturbations.size(), 10u);
  for (const TripletGeometry& moved : triplet->pose_perturbations) {
    EXPECT_EQ(moved.cami_from_camj.rotation,
              triplet->geometry.cami_from_camj.rotation);
    const double turned =
        RotationAngleBetween(moved.camk_from_camj.rotation,
                             triplet->geometry.camk_from_camj.rotation);
    const double tilted =
        AngleBetween(moved.camk_from_camj.translation,
                     triplet->geometry.camk_from_camj.translation);
    EXPECT_NEAR(std::hypot(turned, tilted), 1e-3, 1e-6);
  }
}

TEST(MakeTripletView, MissingPartsAreErrors) {
  const RowOfViews row;
  const auto error_of = [](const Scene& scene, const ViewTriplet& views) {
    return MakeTripletView(SceneFeatures(scene), views).error().code;
  };
  EXPECT_EQ(error_of(row.scene, {0, 1, 9}), ErrorCode::kInvalidArgument);
  Scene scene = row.scene;
  scene.relative_poses.at({0, 1}).point_inliers.push_back({0, 1000});
  EXPECT_EQ(error_of(scene, {0, 1, 2}), ErrorCode::kInvalidScene);
  EXPECT_FALSE(EstimateScaleRatios(scene, {}, {}).has_value());
  scene = row.scene;
  scene.views[1].intrinsic_id = kInvalidId;
  EXPECT_EQ(error_of(scene, {0, 1, 2}), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace lowlap
