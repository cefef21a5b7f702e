#include <gtest/gtest.h>

#include <algorithm>

#include "lowlap/directions/internal/vanishing_directions.h"
#include "lowlap/two_view/internal/kernels/two_point_kernel.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "support/matchers.h"
#include "two_view/line_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::IsOk;
using testing::LineScene;
using testing::LineSceneOptions;
using testing::MakeLineScene;
using testing::MakeSegment;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

struct WithDirections {
  explicit WithDirections(const LineScene& scene)
      : directions1(FindVanishingDirections(scene.views.features1, {})),
        directions2(FindVanishingDirections(scene.views.features2, {})),
        input(scene.Input()) {
    input.directions1 = &directions1;
    input.directions2 = &directions2;
  }
  std::vector<VanishingDirection> directions1, directions2;
  TwoViewInput input;
};

TEST(TwoPointKernel, FindsTheDirectionFromTwoMatches) {
  const auto scene = MakeTwoViewScene({}, 1);
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel essential(pairs);
  const TwoPointKernel kernel(essential, scene.cam2_from_cam1.rotation, {});
  for (int n = 0; n < 20; ++n) {
    std::vector<RigidTransform> models;
    kernel.Solve({n, n + 30}, models);
    ASSERT_EQ(models.size(), 1u);
    EXPECT_LT(DirectionErrorDeg(models[0].translation,
                                scene.cam2_from_cam1.translation),
              1e-6);
  }
}

TEST(TwoPointKernel, HasNoModelForOnePointTwice) {
  const auto scene = MakeTwoViewScene({}, 1);
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel essential(pairs);
  const TwoPointKernel kernel(essential, scene.cam2_from_cam1.rotation, {});
  std::vector<RigidTransform> models;
  kernel.Solve({4, 4}, models);
  EXPECT_TRUE(models.empty());
}

TEST(RelativePoseFromLines, NeedsNoPoint) {
  for (int seed = 0; seed < 5; ++seed) {
    LineSceneOptions options;
    options.noise_px = 0.3;
    options.lines_per_family = 24;
    const auto scene = MakeLineScene(options, 20 + seed);
    const WithDirections lines(scene);
    const auto result = EstimateRelativePose(lines.input, {}, 1);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_LT(
        RotationErrorDeg(result->pose.rotation, scene.cam2_from_cam1.rotation),
        0.5)
        << "seed " << seed;
    EXPECT_LT(DirectionErrorDeg(result->pose.direction,
                                scene.cam2_from_cam1.translation),
              3)
        << "seed " << seed;
    EXPECT_TRUE(result->pose.point_inliers.empty());
  }
}

TEST(RelativePoseFromLines, LinesSharpenTheRotationOfFewNoisyPoints) {
  double with_lines = 0, points_only = 0;
  constexpr int kTrials = 40;
  for (int seed = 0; seed < kTrials; ++seed) {
    LineSceneOptions options;
    options.noise_px = 0.3;
    LineScene scene = MakeLineScene(options, 200 + seed);
    TwoViewSceneOptions points;
    points.num_right = 30;
    points.num_wrong = 10;
    points.noise_px = 1;
    const auto cloud = MakeTwoViewScene(points, 300 + seed);
    scene.views.features1.points = cloud.features1.points;
    scene.views.features2.points = cloud.features2.points;
    scene.views.matches = cloud.matches;
    const WithDirections lines(scene);
    TwoViewInput alone = lines.input;
    alone.line_matches.clear();
    const auto both = EstimateRelativePose(lines.input, {}, 1);
    const auto only = EstimateRelativePose(alone, {}, 1);
    ASSERT_TRUE(both && only);
    const Mat3& truth = scene.cam2_from_cam1.rotation;
    with_lines += RotationErrorDeg(both->pose.rotation, truth) / kTrials;
    points_only += RotationErrorDeg(only->pose.rotation, truth) / kTrials;
  }
  EXPECT_LT(with_lines, 0.6 * points_only);
  EXPECT_LT(with_lines, 0.1);
}

// Many points of one plane, which fit one of its two motions better by how
// their errors fell, and parallel lines on it.
TEST(RelativePoseFromLines, OneDirectionOrdersTheMotionsOfAPlane) {
  const TwoViewSceneOptions options = testing::AmbiguousPlaneOfManyPoints();
  constexpr FeatureIndex kLines = 12;
  int num_first_without = 0;
  for (int seed = 28; seed < 36; ++seed) {
    LineScene scene;
    scene.views = MakeTwoViewScene(options, seed);
    scene.cam2_from_cam1 = options.cam2_from_cam1;
    Random random(seed);
    const auto image = [&](const Vec3& p) -> Vec3 {
      const Vec2 noise = testing::GaussianVec2(random, 1) / testing::kFocalPx;
      return p / p.z() + Vec3(noise.x(), noise.y(), 0);
    };
    const Vec3 along = testing::kPlaneNormal.cross(Vec3(1, 0, 0)).normalized();
    for (FeatureIndex n = 0; n < kLines; ++n) {
      const Vec3 ray = testing::RandomImagePoint(random);
      const Vec3 a = ray / testing::kPlaneNormal.dot(ray), b = a + along;
      const Vec3 start1 = image(a), end1 = image(b);
      const Vec3 start2 = image(scene.cam2_from_cam1 * a);
      const Vec3 end2 = image(scene.cam2_from_cam1 * b);
      scene.views.features1.segments.push_back(MakeSegment(start1, end1));
      scene.views.features2.segments.push_back(MakeSegment(start2, end2));
      scene.line_matches.push_back({n, n});
    }
    const auto is_right = [&](const Result<TwoViewResult>& result) {
      return result && RotationErrorDeg(result->pose.rotation,
                                        scene.cam2_from_cam1.rotation) < 3;
    };
    const WithDirections lines(scene);
    const auto result = EstimateRelativePose(lines.input, {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_TRUE(is_right(result)) << seed;
    num_first_without +=
        is_right(EstimateRelativePose(scene.views.Input(), {}, seed));
  }
  EXPECT_LT(num_first_without, 8);
}

// Lines of two directions matched crosswise, as those of shelves or tiles may
// be: a rotation that brings the false pairs of directions together has nothing
// against it, nor a point for it.
TEST(RelativePoseFromLines, FalseDirectionsDoNotHideWhatThePointsSay) {
  constexpr int kLines = 9;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    LineSceneOptions line_options;
    line_options.lines_per_family = kLines;
    line_options.noise_px = 0.3;
    const LineScene lines = MakeLineScene(line_options, seed + 100);
    TwoViewSceneOptions options;
    options.num_right = 30;
    options.num_wrong = 40;
    options.noise_px = 0.5;
    TwoViewScene scene = MakeTwoViewScene(options, seed);
    scene.features1.segments = lines.views.features1.segments;
    scene.features2.segments = lines.views.features2.segments;
    TwoViewInput input = scene.Input();
    for (FeatureIndex n = 0; n < 2 * kLines; ++n) {
      input.line_matches.push_back({n, (n + kLines) % (2 * kLines)});
    }
    const auto directions1 = FindVanishingDirections(scene.features1, {});
    const auto directions2 = FindVanishingDirections(scene.features2, {});
    input.directions1 = &directions1;
    input.directions2 = &directions2;
    const auto result = EstimateRelativePose(input, {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_LT(RotationErrorDeg(result->pose.rotation,
                               options.cam2_from_cam1.rotation),
              2);
    EXPECT_LT(DirectionErrorDeg(result->pose.direction,
                                options.cam2_from_cam1.translation),
              10);
  }
}

TEST(RelativePoseFromLines, RefusesMatchesOfSegmentsThatDoNotExist) {
  LineScene scene = MakeLineScene({}, 1);
  scene.line_matches.push_back({0, 9999});
  const auto result = EstimateRelativePose(scene.Input(), {}, 1);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidArgument);
}

TEST(ImproveRelativePose, RefinesAndKeepsTheEvidence) {
  TwoViewSceneOptions options;
  options.noise_px = 0.3;
  const auto scene = MakeTwoViewScene(options, 7);
  RelativePose start;
  start.views = {3, 8};
  start.rotation = RotationFromAngleAxis(Vec3(0.002, 0, 0.001)) *
                   scene.cam2_from_cam1.rotation;
  start.direction = scene.cam2_from_cam1.translation;
  start.log10_nfa = -12.5;
  start.point_threshold_px = 2;
  const RelativePose improved =
      ImproveRelativePose(scene.Input(), start, false, {});
  EXPECT_EQ(improved.log10_nfa, -12.5);
  EXPECT_LT(RotationErrorDeg(improved.rotation, scene.cam2_from_cam1.rotation),
            0.05);
  EXPECT_GT(improved.point_inliers.size(), 150u);
  EXPECT_TRUE(improved.covariance);
}

}  // namespace
}  // namespace lowlap
