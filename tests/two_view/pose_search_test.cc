#include "lowlap/two_view/internal/search/pose_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/two_view/internal/search/same_pose.h"
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
      for (std::size_t m = 0; m < n; ++m) {
        EXPECT_FALSE(SamePose(candidates[n].pose, candidates[m].pose));
      }
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
  ASSERT_FALSE(candidates.empty());
  EXPECT_LT(candidates[0].direction_penalty, 1);
}

// With a false direction the rotation is a false one, too, and has a candidate
// that is not the best.
TEST(PoseSearch, WrongDirectionsDoNotWin) {
  const TwoViewScene scene = NoisyScene(11);
  const PointPairs pairs = scene.Pairs();
  const Mat3 wrong = RotationFromAngleAxis(Vec3(0, RadFromDeg(20), 0)) *
                     scene.cam2_from_cam1.rotation;
  std::vector<DirectionPair> directions;
  for (const Vec3& direction : {Vec3(1, 0.1, 0.3), Vec3(0.1, 1, 0.2)}) {
    DirectionPair pair;
    pair.direction1 = direction.normalized();
    pair.direction2 = wrong * pair.direction1;
    pair.covariance1 = pair.covariance2 = 1e-6 * Mat3::Identity();
    pair.num_matches = 3;
    directions.push_back(pair);
  }
  PoseSearch search(pairs, directions, kLaw, {});
  Random random(1);
  int num_samples = 0;
  const auto candidates = search.Search(random, num_samples);
  ASSERT_GE(candidates.size(), 2u);
  EXPECT_TRUE(SamePose(candidates[0].pose, scene.cam2_from_cam1));
  EXPECT_NEAR(candidates[0].direction_penalty, 6, 1e-9);
  EXPECT_NEAR(candidates[0].score, search.ScoreOf(candidates[0].pose), 1e-9);
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

TEST(PoseSearch, CoreScoresCountEveryPerfectMatch) {
  TwoViewSceneOptions exact;
  exact.num_right = 40;
  const TwoViewScene scene = MakeTwoViewScene(exact, 30);
  const PointPairs pairs = scene.Pairs();
  const PoseSearch search(pairs, {}, kLaw, {});
  const std::vector<double> scores = search.CoreScores(scene.cam2_from_cam1, 1);
  ASSERT_EQ(scores.size(), 40u);
  for (const double score : scores) EXPECT_NEAR(score, std::log(10.0), 1e-6);
}

}  // namespace
}  // namespace lowlap
