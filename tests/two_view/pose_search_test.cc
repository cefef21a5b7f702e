#include "lowlap/two_view/internal/pose_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

const BackgroundLaw kLaw = BackgroundLaw::PointToLine(1600.0 * 1200, 2000);

TwoViewScene NoisyScene(std::uint64_t seed) {
  TwoViewSceneOptions options;
  options.num_wrong = 60;
  options.noise_px = 0.4;
  return MakeTwoViewScene(options, seed);
}

TEST(PoseSearch, TheBestCandidateIsTheTruth) {
  for (int seed = 0; seed < 4; ++seed) {
    const TwoViewScene scene = NoisyScene(seed);
    const PointPairs pairs = scene.Pairs();
    PoseSearch search(pairs, {}, kLaw, {});
    Random random(seed);
    int num_samples = 0;
    const auto candidates = search.Search(random, num_samples);
    ASSERT_FALSE(candidates.empty());
    EXPECT_GT(num_samples, 0);
    EXPECT_LT(RotationErrorDeg(candidates[0].pose.rotation,
                               scene.cam2_from_cam1.rotation),
              0.2);
    EXPECT_LT(candidates[0].support.log10_nfa, -100);
    for (std::size_t n = 1; n < candidates.size(); ++n) {
      EXPECT_LE(candidates[n].score, candidates[n - 1].score);
    }
  }
}

TEST(PoseSearch, TwoSharedDirectionsGiveACandidateOfTheirOwn) {
  const TwoViewScene scene = NoisyScene(10);
  const PointPairs pairs = scene.Pairs();
  std::vector<DirectionPair> directions;
  for (const Vec3& direction : {Vec3(1, 0.1, 0.3), Vec3(0.1, 1, 0.2)}) {
    DirectionPair pair;
    pair.direction1 = direction.normalized();
    pair.direction2 = scene.cam2_from_cam1.rotation * pair.direction1;
    pair.covariance1 = pair.covariance2 = 1e-6 * Mat3::Identity();
    pair.num_matches = 10;
    directions.push_back(pair);
  }
  PoseSearch search(pairs, directions, kLaw, {});
  Random random(1);
  int num_samples = 0;
  const auto candidates = search.Search(random, num_samples);
  ASSERT_GE(candidates.size(), 2u);
  EXPECT_LT(candidates[0].direction_penalty, 1);
}

TEST(PoseSearch, FinishingFindsTheSigns) {
  const TwoViewScene scene = NoisyScene(20);
  const PointPairs pairs = scene.Pairs();
  const PoseSearch search(pairs, {}, kLaw, {});
  RigidTransform mirrored = scene.cam2_from_cam1;
  mirrored.translation = -mirrored.translation;
  const PoseCandidate candidate = search.Finish(mirrored);
  EXPECT_TRUE(SamePose(candidate.pose, scene.cam2_from_cam1));
  EXPECT_GT(candidate.inliers.size(), 150u);
  for (const int i : candidate.inliers) EXPECT_LT(i, pairs.size());
}

TEST(PoseSearch, CoreScoreCountsEveryPerfectMatchOnce) {
  TwoViewSceneOptions exact;
  exact.num_right = 40;
  const TwoViewScene scene = MakeTwoViewScene(exact, 30);
  const PointPairs pairs = scene.Pairs();
  const PoseSearch search(pairs, {}, kLaw, {});
  EXPECT_NEAR(search.CoreScore(scene.cam2_from_cam1, 1), 40 * std::log(10.0),
              1e-6);
}

TEST(SamePose, LooksAtRotationAndDirection) {
  const RigidTransform pose{Mat3::Identity(), Vec3::UnitX()};
  RigidTransform other = pose;
  EXPECT_TRUE(SamePose(pose, other));
  other.rotation = RotationFromAngleAxis(Vec3(0, 0, RadFromDeg(0.6)));
  EXPECT_FALSE(SamePose(pose, other));
  other = pose;
  other.translation = Vec3(1, std::tan(RadFromDeg(2.5)), 0).normalized();
  EXPECT_FALSE(SamePose(pose, other));
}

}  // namespace
}  // namespace lowlap
