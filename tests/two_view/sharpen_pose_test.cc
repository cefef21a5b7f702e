#include "lowlap/two_view/internal/search/sharpen_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

#include "lowlap/two_view/internal/planes/planar_motion.h"
#include "lowlap/two_view/internal/search/same_pose.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

double ErrorDeg(const RigidTransform& pose, const TwoViewScene& scene) {
  return RotationErrorDeg(pose.rotation, scene.cam2_from_cam1.rotation) +
         DirectionErrorDeg(pose.translation, scene.cam2_from_cam1.translation);
}

TEST(SharpenPose, ScaleFollowsThePrecisionOfThePoints) {
  for (const auto& [noise_px, least, most] :
       {std::tuple(0.1, 0.3, 0.3), std::tuple(0.3, 0.3, 0.3),
        std::tuple(2.0, 0.6, 2.4)}) {
    TwoViewSceneOptions options;
    options.noise_px = noise_px;
    const TwoViewScene scene = MakeTwoViewScene(options, 1);
    const PointPairs pairs = scene.Pairs();
    Random random(2);
    const SharpenedPoses sharp =
        SharpenPose(EssentialKernel(pairs), scene.cam2_from_cam1, 8, random);
    // Half of the residuals lie within 0.67 deviations, and the core reaches to
    // three scales: 0.3 pixels serve deviations up to 1.3.
    EXPECT_GE(sharp.scale_px, least) << noise_px;
    EXPECT_LE(sharp.scale_px, most) << noise_px;
  }
}

TEST(SharpenPose, LeavesMatchesBesideTheirEpipolarLinesForTheRightOnes) {
  // A third of the matches lie 2 to 4 pixels beside, all on one side. The start
  // is among them.
  TwoViewSceneOptions options;
  options.num_right = 300;
  options.noise_px = 0.2;
  TwoViewScene scene = MakeTwoViewScene(options, 3);
  Random random(4);
  for (int n = 0; n < 300; n += 3) {
    scene.features2.points[n].y() += random.Uniform(2, 4) / testing::kFocalPx;
  }
  const PointPairs pairs = scene.Pairs();
  RigidTransform bent = scene.cam2_from_cam1;
  bent.rotation =
      RotationFromAngleAxis(Vec3(-3 / testing::kFocalPx, 0, 0)) * bent.rotation;
  const SharpenedPoses sharp =
      SharpenPose(EssentialKernel(pairs), bent, 4, random);
  EXPECT_LT(ErrorDeg(sharp.cam2_from_cam1.front(), scene),
            0.5 * ErrorDeg(bent, scene));
  EXPECT_LE(sharp.cam2_from_cam1.size(), 10u);
}

// A plane allows two motions. Whatever motion RANSAC came with, and whatever
// the seed, both are found.
TEST(SharpenPose, FewMatchesKeepAllOptima) {
  TwoViewSceneOptions options;
  options.num_right = 40;
  options.planar = true;
  options.noise_px = 0.2;
  const TwoViewScene scene = MakeTwoViewScene(options, 5);
  const PointPairs pairs = scene.Pairs();
  std::vector<int> all(pairs.size());
  std::iota(all.begin(), all.end(), 0);
  Random plane_random(6);
  const auto plane =
      DominantPlane(scene.cam2_from_cam1, pairs, all, 3, plane_random);
  ASSERT_TRUE(plane);
  const auto twin = OtherPlanarMotion(scene.cam2_from_cam1, plane->normal,
                                      pairs.x1[plane->inliers.front()]);
  ASSERT_TRUE(twin);
  for (int seed = 0; seed < 3; ++seed) {
    for (const RigidTransform& start : {scene.cam2_from_cam1, *twin}) {
      Random random(seed);
      const SharpenedPoses sharp =
          SharpenPose(EssentialKernel(pairs), start, 1, random);
      for (const RigidTransform& motion : {scene.cam2_from_cam1, *twin}) {
        EXPECT_TRUE(std::any_of(sharp.cam2_from_cam1.begin(),
                                sharp.cam2_from_cam1.end(),
                                [&](const RigidTransform& pose) {
                                  return SamePose(pose, motion, 1);
                                }))
            << seed;
      }
    }
  }
}

}  // namespace
}  // namespace lowlap
