#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "averaging/rotations/random_rotation_graph.h"

namespace lowlap {
namespace {

/// Makes the pair's own motion wrong by `turn`; the right one, with a direction
/// and evidence of its own, becomes its alternative.
void PutWrongMotionFirst(const ViewPair& views, const Vec3& turn,
                         Scene* scene) {
  RelativePose& pose = scene->relative_poses.at(views);
  pose.alternatives = {{pose.rotation, Vec3::UnitY(), pose.log10_nfa - 1,
                        Eigen::Matrix<double, 5, 5>::Identity() * 1e-6}};
  pose.rotation = RotationFromAngleAxis(turn) * pose.rotation;
}

std::vector<HypothesisDecision> Decide(Scene* scene, int num_threads = 0) {
  RunContext context;
  context.num_threads = num_threads;
  const auto decisions =
      DecideHypothesesByCycles(scene, PoseOptions(), context);
  EXPECT_TRUE(decisions);
  return decisions ? *decisions : std::vector<HypothesisDecision>();
}

const Vec3 kTurn(0.1, -0.2, 0.1);  // 14 degrees

TEST(DecideHypothesesByCycles, ALoopTakesTheMotionThatClosesIt) {
  const Scene truth = ToScene(MakeRotationGraph(8, 1, 0, 0, 3));
  Scene scene = truth;
  const ViewPair views = {2, 3};
  PutWrongMotionFirst(views, kTurn, &scene);
  const AlternativeMotion right =
      scene.relative_poses.at(views).alternatives[0];
  const auto decisions = Decide(&scene);
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_EQ(decisions[0].views, views);
  EXPECT_EQ(decisions[0].grounds, HypothesisGrounds::kCycles);
  EXPECT_TRUE(decisions[0].replaced);
  const RelativePose& pose = scene.relative_poses.at(views);
  EXPECT_TRUE(pose.alternatives.empty());
  EXPECT_EQ(pose.rotation, right.rotation);
  EXPECT_EQ(pose.direction, right.direction);
  EXPECT_EQ(pose.log10_nfa, right.log10_nfa);
  EXPECT_EQ(pose.covariance, right.covariance);
}

TEST(DecideHypothesesByCycles, TheRightMotionStaysWhereItComesFirst) {
  const Scene truth = ToScene(MakeRotationGraph(8, 1, 0, 0, 3));
  Scene scene = truth;
  const ViewPair views = {2, 3};
  RelativePose& pose = scene.relative_poses.at(views);
  pose.alternatives.resize(1);
  pose.alternatives[0].rotation = RotationFromAngleAxis(kTurn) * pose.rotation;
  const auto decisions = Decide(&scene);
  ASSERT_EQ(decisions.size(), 1u);
  EXPECT_FALSE(decisions[0].replaced);
  EXPECT_TRUE(scene.relative_poses == truth.relative_poses);
}

TEST(DecideHypothesesByCycles, PairsOfOneLoopAreDecidedTogether) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Scene truth = ToScene(MakeRotationGraph(8, 1, 0, 0, seed));
    Scene scene = truth;
    Random random(seed);
    for (const ViewPair& views :
         {ViewPair{0, 1}, ViewPair{2, 3}, ViewPair{4, 5}, ViewPair{0, 7}}) {
      PutWrongMotionFirst(views, RandomVector(&random, 0.5), &scene);
    }
    EXPECT_EQ(Decide(&scene).size(), 4u);
    for (const auto& [views, pose] : scene.relative_poses) {
      EXPECT_EQ(pose.rotation, truth.relative_poses.at(views).rotation);
    }
  }
}

TEST(DecideHypothesesByCycles, FalseRelativePosesDoNotMislead) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const RotationGraph graph = MakeRotationGraph(15, 4, 0.3, 1.0, seed);
    const Scene truth = ToScene(graph);
    Scene scene = truth;
    Random random(seed);
    // More of those that are right than can be tried all together.
    std::set<ViewPair> ambiguous;
    for (std::size_t e = 0; e < graph.measurements.size(); e += 3) {
      if (graph.is_false[e]) continue;
      const RotationMeasurement& m = graph.measurements[e];
      const ViewPair views = {static_cast<ViewId>(std::min(m.first, m.second)),
                              static_cast<ViewId>(std::max(m.first, m.second))};
      PutWrongMotionFirst(views, RandomVector(&random, 0.5), &scene);
      ambiguous.insert(views);
    }
    ASSERT_GT(ambiguous.size(), 7u);
    EXPECT_EQ(Decide(&scene).size(), ambiguous.size()) << seed;
    for (const ViewPair& views : ambiguous) {
      EXPECT_EQ(scene.relative_poses.at(views).rotation,
                truth.relative_poses.at(views).rotation)
          << seed << ": " << views.first << " " << views.second;
    }
  }
}

TEST(DecideHypothesesByCycles, NothingIsDecidedWithoutACycle) {
  RotationGraph graph = MakeRotationGraph(6, 1, 0, 0, 1);
  graph.measurements.pop_back();
  Scene scene = ToScene(graph);
  PutWrongMotionFirst({2, 3}, kTurn, &scene);
  PutWrongMotionFirst({4, 5}, kTurn, &scene);
  const Scene before = scene;
  EXPECT_TRUE(Decide(&scene).empty());
  EXPECT_TRUE(scene == before);
}

TEST(DecideHypothesesByCycles, NothingIsDecidedBetweenLikeRotations) {
  Scene scene = ToScene(MakeRotationGraph(8, 1, 0, 0, 3));
  PutWrongMotionFirst({2, 3}, 0.02 * kTurn, &scene);
  const Scene before = scene;
  EXPECT_TRUE(Decide(&scene).empty());
  EXPECT_TRUE(scene == before);
}

TEST(DecideHypothesesByCycles, NothingIsDecidedWhereNoMotionClosesTheLoop) {
  Scene scene = ToScene(MakeRotationGraph(8, 1, 0, 0, 3));
  PutWrongMotionFirst({2, 3}, kTurn, &scene);
  AlternativeMotion& other =
      scene.relative_poses.at({2, 3}).alternatives.front();
  other.rotation = RotationFromAngleAxis(-kTurn) * other.rotation;
  const Scene before = scene;
  EXPECT_TRUE(Decide(&scene).empty());
  EXPECT_TRUE(scene == before);
}

TEST(DecideHypothesesByCycles, OtherScenesStayAsTheyAre) {
  Scene scene = ToScene(MakeRotationGraph(12, 3, 0.3, 1.0, 7));
  const Scene before = scene;
  EXPECT_TRUE(Decide(&scene).empty());
  EXPECT_TRUE(scene == before);
  Scene empty;
  EXPECT_TRUE(Decide(&empty).empty());
}

TEST(DecideHypothesesByCycles, IsTheSameForAnyNumberOfThreads) {
  Scene one = ToScene(MakeRotationGraph(15, 4, 0.4, 1.0, 5));
  for (std::uint32_t n = 0; n < 12; ++n) {
    PutWrongMotionFirst({n, n + 1}, kTurn, &one);
  }
  Scene two = one;
  Decide(&one, 1);
  Decide(&two, 2);
  EXPECT_TRUE(one == two);
}

TEST(ChooseHypothesis, NeedsTheMarginToTheNextOfAllMotions) {
  RelativePose pose;
  pose.alternatives.resize(2);
  pose.alternatives[1].direction = Vec3::UnitZ();
  const RelativePose before = pose;
  HypothesisDecision decision =
      ChooseHypothesis({9, 3, 1}, 2.5, HypothesisGrounds::kTriplets, &pose);
  EXPECT_EQ(decision.grounds, HypothesisGrounds::kNone);
  EXPECT_EQ(decision.margin, 2);
  EXPECT_TRUE(pose == before);
  decision =
      ChooseHypothesis({9, 3, 1}, 1.5, HypothesisGrounds::kTriplets, &pose);
  EXPECT_EQ(decision.grounds, HypothesisGrounds::kTriplets);
  EXPECT_TRUE(decision.replaced);
  EXPECT_EQ(pose.direction, Vec3::UnitZ());
  EXPECT_TRUE(pose.alternatives.empty());
}

}  // namespace
}  // namespace lowlap
