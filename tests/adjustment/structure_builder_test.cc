#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/structure/track_fit.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/validation.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;
using testing::IsError;
using testing::IsOk;

StructureSummary Build(Scene* scene, const StructureOptions& options = {}) {
  const Result<StructureSummary> summary = BuildStructure(scene, options, {});
  EXPECT_THAT(summary, IsOk());
  EXPECT_THAT(ValidateScene(*scene), IsOk());
  return summary.value_or(StructureSummary{});
}

TEST(Agreement, RoundingDecidesNothing) {
  Agreement one, other;
  one.count = other.count = 2;
  one.squares = 1e-27;
  other.squares = 1e-13;
  EXPECT_FALSE(one.BetterThan(other));
  EXPECT_FALSE(other.BetterThan(one));
  other.squares = 0.01;
  EXPECT_TRUE(one.BetterThan(other));
  other.count = 3;
  EXPECT_TRUE(other.BetterThan(one));
}

// A track's outcome is counted once.
void ExpectComplete(const TriangulationSummary& s) {
  EXPECT_EQ(s.tracks, s.landmarks + s.too_few_views + s.inconsistent +
                          s.behind_camera + s.uncertain + s.implausible);
}

TEST(StructureBuilderTest, ExactTracksGiveExactStructure) {
  TestScene test = MakeTestScene({});
  const StructureSummary summary = Build(&test.scene);
  EXPECT_EQ(summary.points.landmarks, test.true_points.size());
  EXPECT_EQ(summary.points.observations_dropped, 0u);
  for (const auto& [id, landmark] : test.scene.structure) {
    EXPECT_LT((landmark.position - test.true_points.at(id)).norm(), 1e-7);
    EXPECT_EQ(landmark.observations.size(),
              test.scene.point_tracks.at(id).size());
  }
  EXPECT_GT(summary.lines.landmarks, 0.95 * test.true_lines.size());
  for (const auto& [id, line] : test.scene.line_structure) {
    const PluckerLine& truth = test.true_lines.at(id);
    EXPECT_LT(line.line.direction.cross(truth.direction).norm(), 1e-7);
    EXPECT_LT((truth.ClosestPointTo(line.start) - line.start).norm(), 1e-6);
    EXPECT_LT((truth.ClosestPointTo(line.end) - line.end).norm(), 1e-6);
  }
}

TEST(StructureBuilderTest, ExtentIsWhatTheSegmentsCover) {
  TestSceneOptions options;
  options.num_lines = 60;
  TestScene test = MakeTestScene(options);
  Build(&test.scene);
  for (const auto& [id, line] : test.scene.line_structure) {
    // The lines are 0.6 to 1.6 m long and seen over 0.8 to 1 of it.
    const double length = (line.end - line.start).norm();
    EXPECT_GT(length, 0.45);
    EXPECT_LT(length, 1.61);
  }
}

TEST(StructureBuilderTest, TracksOfTwoViewsAreLandmarksToo) {
  TestSceneOptions options;
  options.max_point_views = 2;
  options.max_line_views = 2;
  options.noise_px = 0.5;
  TestScene test = MakeTestScene(options);
  const StructureSummary summary = Build(&test.scene);
  EXPECT_GT(summary.points.landmarks, 0.95 * test.true_points.size());
  EXPECT_EQ(summary.points.two_view_landmarks, summary.points.landmarks);
  EXPECT_GT(summary.lines.landmarks, 0.85 * test.true_lines.size());
  ExpectComplete(summary.points);
  ExpectComplete(summary.lines);
}

TEST(StructureBuilderTest, OutliersAreLeftOutAndTheRestOfTheTrackIsKept) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  options.point_outliers = 0.15;
  options.line_outliers = 0.1;
  TestScene test = MakeTestScene(options);
  const StructureSummary summary = Build(&test.scene);
  ExpectComplete(summary.points);
  ExpectComplete(summary.lines);
  const std::set<FeatureRef> outliers(test.outlier_points.begin(),
                                      test.outlier_points.end());
  std::size_t wrong = 0, used = 0;
  for (const auto& [id, landmark] : test.scene.structure) {
    for (const PointObservation& observation : landmark.observations) {
      ++used;
      wrong += outliers.count({observation.view, observation.feature});
    }
  }
  EXPECT_LT(wrong, 0.01 * used);
  std::size_t total = 0;
  for (const auto& [id, track] : test.scene.point_tracks) total += track.size();
  EXPECT_GT(used, 0.95 * (total - outliers.size()));

  const std::set<FeatureRef> wrong_segments(test.outlier_segments.begin(),
                                            test.outlier_segments.end());
  std::size_t wrong_lines = 0, used_lines = 0;
  for (const auto& [id, line] : test.scene.line_structure) {
    if (line.observations.size() < 3) continue;  // two views always agree
    for (const FeatureRef& ref : line.observations) {
      ++used_lines;
      wrong_lines += wrong_segments.count(ref);
    }
  }
  EXPECT_LT(wrong_lines, 0.02 * used_lines);
}

TEST(StructureBuilderTest, WrongLinesOfTwoViewsAreMostlyImplausible) {
  TestSceneOptions options;
  options.max_line_views = 2;
  options.line_outliers = 0.5;
  options.num_lines = 400;
  TestScene test = MakeTestScene(options);
  const StructureSummary summary = Build(&test.scene);
  const std::set<FeatureRef> wrong_segments(test.outlier_segments.begin(),
                                            test.outlier_segments.end());
  std::size_t wrong_tracks = 0, wrong_lines = 0;
  for (const auto& [id, track] : test.scene.line_tracks) {
    const bool wrong =
        wrong_segments.count(track[0]) + wrong_segments.count(track[1]) > 0;
    wrong_tracks += wrong ? 1 : 0;
    wrong_lines += wrong && test.scene.line_structure.count(id) > 0 ? 1 : 0;
  }
  ASSERT_GT(wrong_tracks, 200u);
  EXPECT_LT(wrong_lines, 0.4 * wrong_tracks);
  EXPECT_GT(summary.lines.implausible + summary.lines.behind_camera, 100u);
}

TEST(StructureBuilderTest, BadPosesWidenTheThresholdInsteadOfEmptyingTracks) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.01, 0.05, 3, &test.scene);
  const StructureSummary summary = Build(&test.scene);
  EXPECT_GT(summary.points.threshold_px, 10);
  EXPECT_GT(summary.points.observations_used,
            0.9 * summary.points.observations);
}

TEST(StructureBuilderTest, ThresholdOfTheOptionsIsHonoured) {
  TestSceneOptions options;
  options.noise_px = 1;
  TestScene test = MakeTestScene(options);
  StructureOptions structure;
  structure.max_point_error_px = 1;
  const StructureSummary summary = Build(&test.scene, structure);
  EXPECT_EQ(summary.points.threshold_px, 1);
  for (const auto& [id, landmark] : test.scene.structure) {
    for (const PointObservation& observation : landmark.observations) {
      const Vec3 x = test.scene.FindPose(observation.view)->CamFromWorld() *
                     landmark.position;
      EXPECT_LE((test.scene.intrinsics.at(7).Project(x) - observation.pixel_px)
                    .norm(),
                1 + 1e-9);
    }
  }
}

TEST(StructureBuilderTest, HopelessDepthIsUncertainNotALandmark) {
  TestScene test = MakeTestScene({});
  // A point at 20 km: a baseline of 6 m turns its ray by 0.2 px.
  const Vec3 far(0, 0, 20000);
  const PointTrackId id = 9999;
  for (const auto& [view, features] : test.scene.features) {
    const Vec3 x = test.scene.FindPose(view)->CamFromWorld() * far;
    auto& points = test.scene.features.at(view).points_px;
    test.scene.point_tracks[id].push_back(
        {view, static_cast<FeatureIndex>(points.size())});
    points.push_back(test.scene.intrinsics.at(7).Project(x));
  }
  const StructureSummary summary = Build(&test.scene);
  EXPECT_EQ(summary.points.uncertain, 1u);
  EXPECT_EQ(test.scene.structure.count(id), 0u);
}

TEST(StructureBuilderTest, PointBehindTheCamerasIsCounted) {
  TestScene test = MakeTestScene({});
  const Vec3 behind(3, 0, -5);
  const PointTrackId id = 9999;
  // Its projection through the centre is a pixel all the same.
  for (const ViewId view : {ViewId{7}, ViewId{9}}) {
    const Vec3 x = test.scene.FindPose(view)->CamFromWorld() * behind;
    auto& points = test.scene.features.at(view).points_px;
    test.scene.point_tracks[id].push_back(
        {view, static_cast<FeatureIndex>(points.size())});
    points.push_back(test.scene.intrinsics.at(7).Project(x));
  }
  const StructureSummary summary = Build(&test.scene);
  EXPECT_EQ(summary.points.behind_camera, 1u);
  EXPECT_EQ(test.scene.structure.count(id), 0u);
}

TEST(StructureBuilderTest, LineInAnEpipolarPlaneIsUncertain) {
  TestSceneOptions options;
  options.num_lines = 0;
  TestScene test = MakeTestScene(options);
  // A line parallel to the baseline of views 3 and 5, seen in these two.
  const Vec3 a = test.scene.FindPose(3)->center;
  const Vec3 b = test.scene.FindPose(5)->center;
  const Vec3 start = 0.5 * (a + b) + Vec3(-0.5, 0.5, 6);
  const Vec3 end = start + (b - a);
  for (const ViewId view : {ViewId{3}, ViewId{5}}) {
    const RigidTransform cam = test.scene.FindPose(view)->CamFromWorld();
    const Intrinsic& intrinsic = test.scene.intrinsics.at(7);
    test.scene.features.at(view).segments.push_back(
        {intrinsic.Project(cam * start), intrinsic.Project(cam * end), 0.5});
    test.scene.line_tracks[1].push_back({view, 0});
  }
  const StructureSummary summary = Build(&test.scene);
  EXPECT_EQ(summary.lines.uncertain, 1u);
  EXPECT_TRUE(test.scene.line_structure.empty());
}

TEST(StructureBuilderTest, BrokenSegmentsOfOneViewBelongToOneLine) {
  TestSceneOptions options;
  options.num_lines = 20;
  TestScene test = MakeTestScene(options);
  auto& [id, track] = *test.scene.line_tracks.begin();
  const FeatureRef broken = track.front();
  auto& segments = test.scene.features.at(broken.view).segments;
  const LineSegment whole = segments[broken.feature];
  const Vec2 middle = 0.5 * (whole.start_px + whole.end_px);
  segments[broken.feature].end_px = middle;
  track.push_back({broken.view, static_cast<FeatureIndex>(segments.size())});
  segments.push_back({middle, whole.end_px, 0.5});
  std::sort(track.begin(), track.end());
  Build(&test.scene);
  ASSERT_EQ(test.scene.line_structure.count(id), 1u);
  EXPECT_EQ(test.scene.line_structure.at(id).observations, track);
}

TEST(StructureBuilderTest, ViewsWithoutPoseOrIntrinsicAreLeftOut) {
  TestSceneOptions options;
  options.max_point_views = 2;
  TestScene test = MakeTestScene(options);
  test.scene.poses.erase(102);  // of view 7
  test.scene.views.at(5).intrinsic_id = kInvalidId;
  const StructureSummary summary = Build(&test.scene);
  EXPECT_GT(summary.points.too_few_views, 0u);
  ExpectComplete(summary.points);
  for (const auto& [id, landmark] : test.scene.structure) {
    for (const PointObservation& observation : landmark.observations) {
      EXPECT_NE(observation.view, 5u);
      EXPECT_NE(observation.view, 7u);
    }
  }
}

TEST(StructureBuilderTest, NoPosesGiveNoStructure) {
  TestScene test = MakeTestScene({});
  test.scene.poses.clear();
  const StructureSummary summary = Build(&test.scene);
  EXPECT_EQ(summary.points.landmarks, 0u);
  EXPECT_EQ(summary.points.too_few_views, summary.points.tracks);
  EXPECT_TRUE(test.scene.structure.empty());
  Scene empty;
  EXPECT_EQ(Build(&empty).points.tracks, 0u);
}

TEST(StructureBuilderTest, CoplanarInliersBecomePairsOfLines) {
  TestSceneOptions options;
  options.max_line_views = 2;
  options.num_lines = 300;
  options.pairs_per_triplet = 40;
  TestScene test = MakeTestScene(options);
  // Said twice, and once by a ratio that means nothing.
  ScaleRatio& ratio = test.scene.scale_ratios.front();
  ratio.coplanar_inliers.push_back(ratio.coplanar_inliers.front());
  test.scene.scale_ratios.back().verdict = RatioVerdict::kNotMeaningful;
  const std::size_t ignored =
      test.scene.scale_ratios.back().coplanar_inliers.size();
  std::size_t inliers = 0;
  for (const ScaleRatio& r : test.scene.scale_ratios) {
    inliers += r.coplanar_inliers.size();
  }
  const StructureSummary summary = Build(&test.scene);
  EXPECT_EQ(summary.coplanar_inliers, inliers - ignored);
  EXPECT_EQ(summary.coplanar_pairs, test.scene.coplanar_pairs.size());
  EXPECT_EQ(summary.coplanar_inliers,
            summary.coplanar_pairs + summary.coplanar_duplicates +
                summary.coplanar_parallel + summary.coplanar_without_lines);
  EXPECT_GE(summary.coplanar_duplicates + summary.coplanar_parallel +
                summary.coplanar_without_lines,
            1u);
  EXPECT_GT(summary.coplanar_pairs, 0.7 * summary.coplanar_inliers);
  const double min_sine = std::sin(RadFromDeg(10));
  for (const CoplanarPair& pair : test.scene.coplanar_pairs) {
    EXPECT_LT(pair.first, pair.second);
    EXPECT_EQ(test.wall_of_line.at(pair.first),
              test.wall_of_line.at(pair.second));
    EXPECT_GE(
        test.scene.line_structure.at(pair.first)
            .line.direction
            .cross(test.scene.line_structure.at(pair.second).line.direction)
            .norm(),
        min_sine);
  }
}

TEST(StructureBuilderTest, KindsThatAreOffAreCleared) {
  TestSceneOptions options;
  options.pairs_per_triplet = 10;
  options.max_line_views = 2;
  TestScene test = MakeTestScene(options);
  Build(&test.scene);
  EXPECT_FALSE(test.scene.line_structure.empty());
  StructureOptions points_only;
  points_only.use_lines = false;
  Build(&test.scene, points_only);
  EXPECT_FALSE(test.scene.structure.empty());
  EXPECT_TRUE(test.scene.line_structure.empty());
  EXPECT_TRUE(test.scene.coplanar_pairs.empty());
}

TEST(StructureBuilderTest, SameForAnyNumberOfThreads) {
  TestSceneOptions options;
  options.noise_px = 0.5;
  options.point_outliers = 0.1;
  options.line_outliers = 0.1;
  TestScene one = MakeTestScene(options);
  TestScene many = MakeTestScene(options);
  RunContext context;
  context.num_threads = 1;
  ASSERT_THAT(BuildStructure(&one.scene, {}, context), IsOk());
  context.num_threads = 4;
  ASSERT_THAT(BuildStructure(&many.scene, {}, context), IsOk());
  EXPECT_TRUE(one.scene == many.scene);
}

TEST(StructureBuilderTest, SameInAnyUnitOfTheWorld) {
  TestSceneOptions options;
  options.noise_px = 0.3;
  TestScene test = MakeTestScene(options);
  const auto summary = BuildStructure(&test.scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  ASSERT_GT(summary->lines.landmarks, 0u);
  for (const double scale : {1e-6, 1e6}) {
    Scene scaled =
        test::Transformed(test.scene, {scale, Mat3::Identity(), Vec3::Zero()});
    const auto of_scaled = BuildStructure(&scaled, {}, {});
    ASSERT_THAT(of_scaled, IsOk());
    EXPECT_EQ(of_scaled->points.landmarks, summary->points.landmarks) << scale;
    EXPECT_EQ(of_scaled->lines.landmarks, summary->lines.landmarks) << scale;
  }
}

TEST(StructureBuilderTest, DistortedAndPanoramicViews) {
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
    const StructureSummary summary = Build(&test.scene);
    EXPECT_GT(summary.points.landmarks, 0.98 * test.true_points.size());
    for (const auto& [id, landmark] : test.scene.structure) {
      EXPECT_LT((landmark.position - test.true_points.at(id)).norm(), 1e-5);
    }
    EXPECT_GT(summary.lines.landmarks, 0.9 * test.true_lines.size());
    for (const auto& [id, line] : test.scene.line_structure) {
      EXPECT_LT(LineDistance(line.line, test.true_lines.at(id)), 1e-5);
    }
  }
}

TEST(StructureBuilderTest, BadInputIsNamed) {
  EXPECT_THAT(BuildStructure(nullptr, {}, {}),
              IsError(ErrorCode::kInvalidArgument, "null"));
  TestScene test = MakeTestScene({});
  StructureOptions options;
  options.max_line_error_px = -1;
  EXPECT_THAT(BuildStructure(&test.scene, options, {}),
              IsError(ErrorCode::kInvalidArgument, "max_line_error_px"));
  options.max_line_error_px = std::nan("");
  EXPECT_THAT(BuildStructure(&test.scene, options, {}),
              IsError(ErrorCode::kInvalidArgument, "max_line_error_px"));
  test.scene.poses.at(101).center.x() =
      std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(BuildStructure(&test.scene, {}, {}),
              IsError(ErrorCode::kInvalidScene, "finite"));
  TestScene dangling = MakeTestScene({});
  dangling.scene.point_tracks.begin()->second.front().feature = 1000000;
  EXPECT_THAT(BuildStructure(&dangling.scene, {}, {}),
              IsError(ErrorCode::kInvalidScene, ""));
  RunContext cancel;
  cancel.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  TestScene good = MakeTestScene({});
  ASSERT_THAT(BuildStructure(&good.scene, {}, {}), IsOk());
  const Scene before = good.scene;
  good.scene.poses.begin()->second.center.x() += 0.1;
  const Scene moved = good.scene;
  EXPECT_THAT(BuildStructure(&good.scene, {}, cancel),
              IsError(ErrorCode::kCancelled, ""));
  EXPECT_TRUE(good.scene == moved);
  EXPECT_TRUE(good.scene.structure == before.structure);
}

}  // namespace
}  // namespace lowlap
