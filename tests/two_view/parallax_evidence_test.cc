#include "lowlap/two_view/internal/planes/parallax_evidence.h"

#include <gtest/gtest.h>

#include "tests/support/random_vectors.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::kFocalPx;
using testing::MakeTwoViewScene;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

const ScenePlane kPlane{testing::kPlaneNormal, {}};

double EvidenceOf(const TwoViewScene& scene) {
  return ParallaxEvidence(scene.cam2_from_cam1, kPlane, scene.Pairs(), 1);
}

TwoViewSceneOptions PlanarOptions() {
  TwoViewSceneOptions options;
  options.planar = true;
  options.noise_px = 0.3;
  return options;
}

TEST(ParallaxEvidence, PointsOfOnePlaneGiveNone) {
  TwoViewSceneOptions options = PlanarOptions();
  options.num_wrong = 100;  // anywhere
  for (int seed = 0; seed < 20; ++seed) {
    EXPECT_GE(EvidenceOf(MakeTwoViewScene(options, seed)), 0) << seed;
  }
}

TEST(ParallaxEvidence, AFewPointsOffThePlaneGiveSome) {
  TwoViewSceneOptions options = PlanarOptions();
  options.num_off_plane = 8;
  for (int seed = 0; seed < 20; ++seed) {
    EXPECT_LT(EvidenceOf(MakeTwoViewScene(options, seed)), -3) << seed;
  }
}

TEST(ParallaxEvidence, MismatchesAboutThePlaneGiveNone) {
  TwoViewSceneOptions options = PlanarOptions();
  for (int seed = 0; seed < 20; ++seed) {
    TwoViewScene scene = MakeTwoViewScene(options, seed);
    Random random(100 + seed);
    // A quarter of the points are taken for another one nearby: some of these
    // lie along their epipolar lines by chance.
    for (int i = 0; i < scene.num_right / 4; ++i) {
      scene.features2.points[i].head<2>() +=
          testing::GaussianVec2(random, 10) / kFocalPx;
    }
    EXPECT_GE(EvidenceOf(scene), 0) << seed;
  }
}

TEST(ParallaxEvidence, TwoPointsOffThePlaneFitSomeEpipoleAlways) {
  TwoViewSceneOptions options = PlanarOptions();
  options.num_off_plane = 2;
  EXPECT_GE(EvidenceOf(MakeTwoViewScene(options, 1)), 0);
}

}  // namespace
}  // namespace lowlap
