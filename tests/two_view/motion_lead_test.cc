#include "lowlap/two_view/internal/planes/motion_lead.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::AmbiguousPlaneOfManyPoints;
using testing::MakeTwoViewScene;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

const BackgroundLaw kLaw = BackgroundLaw::PointToLine(1600.0 * 1200, 2000);

/// That of the true motion over the other one.
MotionLead LeadOfTruth(const TwoViewScene& scene,
                       const std::vector<DirectionPair>& directions,
                       std::uint64_t seed) {
  const PointPairs pairs = scene.Pairs();
  const PoseSearch search(pairs, directions, kLaw, {});
  Random random(seed);
  const PoseCandidate truth = search.Finish(scene.cam2_from_cam1);
  const auto other_motion = OtherPlanarMotion(
      scene.cam2_from_cam1, testing::kPlaneNormal, Vec3(0, 0, 1));
  EXPECT_TRUE(other_motion);
  const PoseCandidate other = search.Finish(*other_motion);
  const auto plane_of = [&](const PoseCandidate& candidate) {
    return *DominantPlane(candidate.pose, pairs, candidate.inliers,
                          candidate.support.threshold, random);
  };
  const ScenePlane plane_of_other = plane_of(other);
  return CompareMotions(search, pairs, truth, plane_of(truth), other,
                        &plane_of_other);
}

/// Of eight matched segments, known to a degree in either view.
std::vector<DirectionPair> OneVagueDirection(const TwoViewScene& scene) {
  DirectionPair pair;
  pair.direction1 = Vec3(0.1, 1, 0.2).normalized();
  pair.direction2 = scene.cam2_from_cam1.rotation * pair.direction1;
  pair.covariance1 = pair.covariance2 = 3e-4 * Mat3::Identity();
  pair.num_matches = 8;
  return {pair};
}

TEST(MotionLead, WhatIsBesideThePlaneOrdersWhatIsNotDecided) {
  EXPECT_FALSE((MotionLead{5, 0, 0}).IsBehind());
  EXPECT_TRUE((MotionLead{-5, 0, 0}).IsBehind());
  EXPECT_TRUE((MotionLead{5, 0, -3}).IsBehind());
  EXPECT_FALSE((MotionLead{-5, 0, 3}).IsBehind());
  // Less than a factor of ten tells nothing.
  EXPECT_TRUE((MotionLead{-5, 0, 2}).IsBehind());
  EXPECT_FALSE((MotionLead{-5, 0, 3}).IsDecisive());
  // Decided.
  EXPECT_TRUE((MotionLead{-24, 0, 0}).IsDecisive());
  EXPECT_TRUE((MotionLead{-24, 0, 5}).IsBehind());
  EXPECT_FALSE((MotionLead{24, 0, -5}).IsBehind());
  // But not beyond noise.
  EXPECT_FALSE((MotionLead{24, 9, 0}).IsDecisive());
  EXPECT_TRUE((MotionLead{24, 9, -5}).IsBehind());
}

TEST(CompareMotions, ThePlaneAloneTellsNothingBesideIt) {
  for (int seed = 0; seed < 20; ++seed) {
    const MotionLead lead = LeadOfTruth(
        MakeTwoViewScene(AmbiguousPlaneOfManyPoints(), seed), {}, seed);
    EXPECT_FALSE(lead.IsDecisive()) << seed;
    EXPECT_EQ(lead.beside_plane, 0) << seed;
  }
}

TEST(CompareMotions, AVagueDirectionOrdersWhatThePlaneLeavesOpen) {
  int num_behind_in_all = 0;
  for (int seed = 0; seed < 40; ++seed) {
    const TwoViewScene scene =
        MakeTwoViewScene(AmbiguousPlaneOfManyPoints(), seed);
    const MotionLead lead = LeadOfTruth(scene, OneVagueDirection(scene), seed);
    EXPECT_GT(lead.beside_plane, 2.31) << seed;
    EXPECT_FALSE(lead.IsBehind()) << seed;
    num_behind_in_all += lead.of_all < 0;
  }
  EXPECT_GT(num_behind_in_all, 0);
}

TEST(CompareMotions, PointsOffThePlaneCountWhereTheyLieAlongEpipolarLines) {
  TwoViewSceneOptions options = AmbiguousPlaneOfManyPoints();
  options.num_off_plane = 8;
  for (int seed = 0; seed < 20; ++seed) {
    const MotionLead lead =
        LeadOfTruth(MakeTwoViewScene(options, seed), {}, seed);
    EXPECT_GT(lead.beside_plane, 2.31) << seed;
    EXPECT_FALSE(lead.IsBehind()) << seed;
  }
}

TEST(CompareMotions, MismatchesAboutThePlaneDoNot) {
  for (int seed = 0; seed < 20; ++seed) {
    TwoViewScene scene = MakeTwoViewScene(AmbiguousPlaneOfManyPoints(), seed);
    Random random(100 + seed);
    for (int i = 0; i < scene.num_right / 4; ++i) {
      scene.features2.points[i].head<2>() +=
          testing::GaussianVec2(random, 10) / testing::kFocalPx;
    }
    EXPECT_EQ(LeadOfTruth(scene, {}, seed).beside_plane, 0) << seed;
  }
}

}  // namespace
}  // namespace lowlap
