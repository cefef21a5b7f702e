#include "lowlap/two_view/internal/search/chance_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::MakeTwoViewScene;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

AContrarioLadder Ladder(const EssentialKernel& kernel) {
  return AContrarioLadder(kernel.NumData(), EssentialKernel::kSampleSize,
                          EssentialKernel::kMaxModels,
                          BackgroundLaw::PointToLine(1600.0 * 1200, 2000), 0.1,
                          4);
}

TEST(VisibleSteps, PutsEveryMatchWhereItsResidualIs) {
  TwoViewSceneOptions options;
  options.num_wrong = 50;
  options.noise_px = 0.5;
  const TwoViewScene scene = MakeTwoViewScene(options, 1);
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel kernel(pairs);
  const AContrarioLadder ladder = Ladder(kernel);
  const std::vector<int> steps =
      VisibleSteps(kernel, ladder, scene.cam2_from_cam1);
  std::vector<float> squared(pairs.size());
  kernel.SquaredResiduals(scene.cam2_from_cam1, 0, pairs.size(),
                          squared.data());
  const std::vector<int> visible =
      kernel.VisibleWithinThreshold(scene.cam2_from_cam1, 3);
  for (const int i : visible) {
    // Residuals in single and in double precision may fall on two sides of a
    // step.
    EXPECT_NEAR(steps[i], ladder.Step(squared[i]), 1) << i;
  }
  // A mirrored baseline puts every point behind the cameras, but for those
  // whose parallax noise could feign.
  RigidTransform mirrored = scene.cam2_from_cam1;
  mirrored.translation = -mirrored.translation;
  int num_seen = 0;
  for (const int step : VisibleSteps(kernel, ladder, mirrored)) {
    num_seen += step < ladder.NumSteps();
  }
  EXPECT_LT(num_seen, 5);
}

TEST(ScoreAgainstChance, IsNoBetterThanTheUniformLaw) {
  TwoViewSceneOptions options;
  options.num_wrong = 100;
  options.noise_px = 0.5;
  for (int seed = 0; seed < 5; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(options, 10 + seed);
    const PointPairs pairs = scene.Pairs();
    const EssentialKernel kernel(pairs);
    const AContrarioLadder ladder = Ladder(kernel);
    std::vector<int> counts(ladder.NumSteps() + 1, 0);
    for (const int step : VisibleSteps(kernel, ladder, scene.cam2_from_cam1)) {
      ++counts[step];
    }
    const AContrarioScore score =
        ScoreAgainstChance(kernel, ladder, scene.cam2_from_cam1);
    EXPECT_GE(score.log10_nfa, ladder.Best(counts).log10_nfa);
    EXPECT_LT(score.log10_nfa, -50);
  }
}

TEST(ScoreAgainstChance, DoesNotDependOnTheOrderOfAFewHundred) {
  TwoViewSceneOptions options;
  options.num_wrong = 200;
  options.noise_px = 0.5;
  const TwoViewScene scene = MakeTwoViewScene(options, 15);
  PointPairs pairs = scene.Pairs();
  const auto score = [&] {
    const EssentialKernel kernel(pairs);
    return ScoreAgainstChance(kernel, Ladder(kernel), scene.cam2_from_cam1);
  };
  const AContrarioScore first = score();
  for (int turn = 0; turn < 3; ++turn) {
    std::rotate(pairs.x1.begin(), pairs.x1.begin() + 50, pairs.x1.end());
    std::rotate(pairs.x2.begin(), pairs.x2.begin() + 50, pairs.x2.end());
    std::swap(pairs.x1[turn], pairs.x1[turn + 7]);
    std::swap(pairs.x2[turn], pairs.x2[turn + 7]);
    EXPECT_NEAR(score().log10_nfa, first.log10_nfa, 1e-9);
    EXPECT_EQ(score().threshold, first.threshold);
  }
}

TEST(ScoreAgainstChance, PointsThatCrowdInABandProveLittle) {
  // Unrelated points, all within 3 pixels of one row: any matching of them fits
  // a sideways motion, and that is no evidence for it.
  Random random(5);
  TwoViewScene scene = MakeTwoViewScene({}, 20);
  for (int n = 0; n < 200; ++n) {
    for (NormalizedFeatures* view : {&scene.features1, &scene.features2}) {
      view->points[n].x() = random.Uniform(-0.5, 0.5);
      view->points[n].y() = random.Uniform(-3, 3) / testing::kFocalPx;
    }
  }
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel kernel(pairs);
  const RigidTransform sideways{Mat3::Identity(), Vec3::UnitX()};
  EXPECT_GT(ScoreAgainstChance(kernel, Ladder(kernel), sideways).log10_nfa, 0);
}

TEST(ChanceShare, IsThatOfTheUniformLawForPointsEverywhere) {
  TwoViewSceneOptions options;
  options.num_right = 0;
  options.num_wrong = 600;
  const TwoViewScene scene = MakeTwoViewScene(options, 30);
  const PointPairs pairs = scene.Pairs();
  // Within 4 pixels of a line, times the square root of two for Sampson's
  // distance; about half of the wrong matches are in front of both cameras.
  const double band =
      BackgroundLaw::PointToLine(1600.0 * 1200, 2000).Alpha(4) * std::sqrt(2.0);
  const double share = ChanceShare(pairs, scene.cam2_from_cam1, 4);
  EXPECT_GT(share, 0.1 * band);
  EXPECT_LT(share, band);
}

}  // namespace
}  // namespace lowlap
