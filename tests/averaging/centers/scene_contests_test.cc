#include "lowlap/averaging/centers/internal/scene_contests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "averaging/true_ratios.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

// A scene that is solved, and a contest of one of its relative poses.
struct SolvedScene {
  Scene scene;
  Contest contest;

  explicit SolvedScene(double turn_deg, const Vec3& axis = Vec3::UnitY()) {
    SyntheticOptions options;
    options.num_views = 5;
    options.pairs = "all";
    const SyntheticScene made = SceneWithTrueRatios(options);
    scene = TrueSolution(made);
    contest.links = contest.weakest_links = {{1, 2}};
    contest.contradictions = {{0, 3}};
    contest.views = {2};
    contest.evidence = 20;
    contest.evidence_against = {15};
    RelativePose& pose = scene.relative_poses.at({0, 3});
    const Mat3 turn = RotationFromAngleAxis(RadFromDeg(turn_deg) * axis);
    pose.rotation = turn * pose.rotation;
    pose.direction = turn * pose.direction;
  }

  std::vector<Contest> Staying() const {
    return ContestsThatStay(scene, {contest});
  }
};

TEST(ContestsThatStay, AreThoseThatTheAdjustedPosesDoNotMeet) {
  EXPECT_THAT(SolvedScene(0.5).Staying(), IsEmpty());
  EXPECT_THAT(SolvedScene(5).Staying(), SizeIs(1));
}

TEST(ContestsThatStay, NeedMoreThanHalfTheEvidence) {
  SolvedScene little(5);
  little.contest.evidence_against = {10};
  EXPECT_THAT(little.Staying(), IsEmpty());
  // What is met does not count.
  SolvedScene one_of_two(5);
  one_of_two.contest.contradictions = {{0, 2}, {0, 3}};
  one_of_two.contest.evidence_against = {50, 10};
  EXPECT_THAT(one_of_two.Staying(), IsEmpty());
  one_of_two.contest.evidence_against = {0, 11};
  EXPECT_THAT(one_of_two.Staying(), SizeIs(1));
}

TEST(ContestsThatStay, AreThoseOfViewsThatLostTheirPlace) {
  SolvedScene lost(0);
  lost.scene.poses.erase(lost.scene.views.at(3).pose_id);
  EXPECT_THAT(lost.Staying(), SizeIs(1));
}

}  // namespace
}  // namespace lowlap
