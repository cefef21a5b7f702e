#include "lowlap/two_view/internal/evidence/translation_evidence.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::MakeTwoViewScene;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

TranslationEvidence EvidenceOf(const TwoViewScene& scene) {
  std::vector<int> inliers(scene.num_right);
  std::iota(inliers.begin(), inliers.end(), 0);
  const PointPairs pairs = scene.Pairs();
  return TestTranslation(pairs, scene.cam2_from_cam1, inliers, 1, 0.1);
}

TEST(TestTranslation, ALongBaselineNeedsNoProof) {
  const TranslationEvidence evidence = EvidenceOf(MakeTwoViewScene({}, 1));
  EXPECT_LT(evidence.num_rotation_inliers, 100);
  EXPECT_FALSE(evidence.log10_nfa);
  EXPECT_TRUE(evidence.IsSeen());
}

TEST(TestTranslation, AShortOneProvesItself) {
  TwoViewSceneOptions options;
  options.baseline = 0.02;
  options.noise_px = 0.3;
  const TranslationEvidence evidence = EvidenceOf(MakeTwoViewScene(options, 2));
  EXPECT_GT(evidence.num_rotation_inliers, 150);
  ASSERT_TRUE(evidence.log10_nfa);
  EXPECT_LT(*evidence.log10_nfa, 0);
}

TEST(TestTranslation, WithoutOneTheEvidenceIsUniform) {
  // The true pose has no fit to it, hence nothing but the noise votes.
  TwoViewSceneOptions options;
  options.baseline = 0;
  options.noise_px = 0.5;
  for (int seed = 0; seed < 50; ++seed) {
    const TranslationEvidence evidence =
        EvidenceOf(MakeTwoViewScene(options, 10 + seed));
    EXPECT_EQ(evidence.num_rotation_inliers, 200);
    EXPECT_EQ(evidence.log10_nfa, 0.0) << seed;
    EXPECT_FALSE(evidence.IsSeen());
  }
}

TEST(TestTranslation, CrossingsThatShareALineHaveOneVote) {
  TwoViewSceneOptions options;
  options.baseline = 0.02;
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 2);
  PointPairs pairs = scene.Pairs();
  const std::vector<int> inliers = testing::AllIndices(pairs);
  const auto evidence = [&] {
    return *TestTranslation(pairs, scene.cam2_from_cam1, inliers, 1, 0.1)
                .log10_nfa;
  };
  const double of_points = evidence();
  for (int n = 0; n < 200; ++n) pairs.lines.push_back({2 * n, 2 * n + 1});
  EXPECT_EQ(evidence(), of_points);
  for (int n = 0; n < 200; ++n) pairs.lines[n] = {n / 4, 1000 + n};
  EXPECT_GT(evidence(), 0.5 * of_points);
  EXPECT_LT(of_points, 0);
}

TEST(TestTranslation, NothingMovesInACopy) {
  TwoViewScene scene = MakeTwoViewScene({}, 3);
  scene.features2.points = scene.features1.points;
  scene.cam2_from_cam1 = {Mat3::Identity(), Vec3::UnitX()};
  const TranslationEvidence evidence = EvidenceOf(scene);
  EXPECT_EQ(evidence.num_rotation_inliers, 200);
  EXPECT_EQ(evidence.log10_nfa, 0.0);
}

TEST(TestTranslation, ElongatedErrorsAreNoParallax) {
  // Points on vertical edges move along these; with a vertical baseline, that
  // is along the epipolar lines, ten times farther than across.
  TwoViewSceneOptions options;
  options.baseline = 0;
  options.cam2_from_cam1 = {RotationFromAngleAxis(Vec3(0.02, 0.1, 0)),
                            Vec3::UnitY()};
  TwoViewScene scene = MakeTwoViewScene(options, 4);
  Random random(5);
  for (Vec3& x : scene.features2.points) {
    x.x() += random.Gaussian(0.1) / testing::kFocalPx;
    x.y() += random.Gaussian(1.0) / testing::kFocalPx;
  }
  PointPairs pairs = scene.Pairs();
  const Mat2 upright = Vec2(1, 100).asDiagonal();
  pairs.covariance1.assign(200, 1e-6 * Mat2::Identity());
  pairs.covariance2.assign(200, upright);
  std::vector<int> inliers(200);
  std::iota(inliers.begin(), inliers.end(), 0);
  EXPECT_FALSE(
      TestTranslation(pairs, scene.cam2_from_cam1, inliers, 1, 0.01).IsSeen());
  pairs.covariance2.assign(200, Mat2::Identity());
  EXPECT_TRUE(
      TestTranslation(pairs, scene.cam2_from_cam1, inliers, 1, 0.01).IsSeen());
}

}  // namespace
}  // namespace lowlap
