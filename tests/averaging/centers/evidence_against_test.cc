#include "lowlap/averaging/centers/internal/evidence_against.h"

#include <gtest/gtest.h>

#include "averaging/true_ratios.h"
#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

// With the true poses, and the relative pose of 1 and 3 turned.
Scene SceneWithOneTurned(double degrees) {
  SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "all";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  Scene scene = std::move(synthetic.scene);
  for (const auto& [view, pose] : synthetic.true_poses) {
    scene.poses[scene.views.at(view).pose_id] = pose;
  }
  for (auto& entry : scene.relative_poses) entry.second.log10_nfa = -40;
  RelativePose& turned = scene.relative_poses.at({1, 3});
  turned.log10_nfa = -25;
  const Vec3 across = turned.direction.cross(Vec3(0.3, -0.5, 0.8)).normalized();
  turned.direction =
      RotationFromAngleAxis(RadFromDeg(degrees) * across) * turned.direction;
  return scene;
}

TEST(EvidenceAgainstPoses, NothingSpeaksAgainstTheTruth) {
  EXPECT_EQ(EvidenceAgainstPoses(SceneWithOneTurned(0), PoseOptions()), 0);
}

TEST(EvidenceAgainstPoses, WhatIsOffFurtherThanADirectionMayBe) {
  PoseOptions options;
  options.least_false_deg = 2;
  EXPECT_EQ(EvidenceAgainstPoses(SceneWithOneTurned(5.5), options), 0);
  EXPECT_EQ(EvidenceAgainstPoses(SceneWithOneTurned(20), options),
            EvidenceOfNfa(-25));
  EXPECT_EQ(EvidenceAgainstPoses(SceneWithOneTurned(180), options),
            EvidenceOfNfa(-25));
}

TEST(EvidenceAgainstPoses, WhatIsTooShortByItsRatios) {
  Scene scene = SceneWithOneTurned(0);
  const auto error = [](ViewId a, ViewId b) {
    return OrderedPair(a, b) == ViewPair{1, 3} ? -0.5 : 0.0;
  };
  for (ScaleRatio& ratio : scene.scale_ratios) {
    const ViewTriplet& v = ratio.views;
    ratio.log_ratio += error(v.middle, v.last) - error(v.first, v.middle);
  }
  EXPECT_EQ(EvidenceAgainstPoses(scene, PoseOptions()), EvidenceOfNfa(-25));
}

TEST(EvidenceAgainstPoses, AViewWithoutAPoseContradictsNothing) {
  Scene scene = SceneWithOneTurned(60);
  scene.poses.erase(scene.views.at(ViewId(3)).pose_id);
  EXPECT_EQ(EvidenceAgainstPoses(scene, PoseOptions()), 0);
}

}  // namespace
}  // namespace lowlap
