#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/pipeline/internal/measure/relative_poses.h"
#include "lowlap/pipeline/internal/output/summary_json.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "pipeline/ambiguous_wall.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::PutWrongMotionFirst;
using testing::Wall;

std::vector<HypothesisDecision> Decide(Scene* scene, int num_threads = 0) {
  RunContext context;
  context.num_threads = num_threads;
  const auto decisions = DecideHypotheses(
      scene, *MakeScaleEstimator(ScaleOptions()), PoseOptions(), context);
  EXPECT_TRUE(decisions) << decisions.error().ToString();
  return decisions ? *decisions : std::vector<HypothesisDecision>();
}

TEST(DecideHypotheses, TripletsDecideOnAChain) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SyntheticScene wall = Wall("chain", seed);
    const Scene truth = wall.scene;
    PutWrongMotionFirst({2, 3}, &wall);
    const auto decisions = Decide(&wall.scene);
    ASSERT_EQ(decisions.size(), 1u);
    EXPECT_EQ(decisions[0].grounds, HypothesisGrounds::kTriplets) << seed;
    EXPECT_TRUE(decisions[0].replaced);
    EXPECT_TRUE(wall.scene == truth);
  }
}

TEST(DecideHypotheses, TripletsDecideWhereEveryPairIsAmbiguous) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SyntheticScene wall = Wall("chain", seed);
    const Scene truth = wall.scene;
    for (const auto& entry : truth.relative_poses) {
      PutWrongMotionFirst(entry.first, &wall);
    }
    for (const HypothesisDecision& decision : Decide(&wall.scene)) {
      EXPECT_EQ(decision.grounds, HypothesisGrounds::kTriplets) << seed;
    }
    EXPECT_TRUE(wall.scene == truth);
  }
}

TEST(DecideHypotheses, CyclesDecideBeforeTriplets) {
  SyntheticScene wall = Wall("window:2", 1);
  const Scene truth = wall.scene;
  PutWrongMotionFirst({2, 3}, &wall);
  PutWrongMotionFirst({0, 2}, &wall);
  for (const HypothesisDecision& decision : Decide(&wall.scene)) {
    EXPECT_EQ(decision.grounds, HypothesisGrounds::kCycles);
    EXPECT_TRUE(decision.replaced);
  }
  EXPECT_TRUE(wall.scene == truth);
}

TEST(DecideHypotheses, WithoutCyclesAndTripletsBothMotionsStay) {
  SyntheticScene wall = Wall("chain", 0);
  Scene& scene = wall.scene;
  PutWrongMotionFirst({0, 1}, &wall);
  scene.relative_poses.erase({1, 2});
  const Scene before = scene;
  std::string logged;
  RunContext context;
  context.log = [&](LogLevel, const std::string& text) { logged += text; };
  const auto decisions = DecideHypotheses(
      &scene, *MakeScaleEstimator(ScaleOptions()), PoseOptions(), context);
  ASSERT_TRUE(decisions);
  LogDecisions(*decisions, scene, context);
  ASSERT_EQ(decisions->size(), 1u);
  EXPECT_EQ((*decisions)[0].views, (ViewPair{0, 1}));
  EXPECT_EQ((*decisions)[0].grounds, HypothesisGrounds::kNone);
  EXPECT_FALSE((*decisions)[0].replaced);
  EXPECT_TRUE(scene == before);
  EXPECT_NE(logged.find(scene.views.at(1).filename), std::string::npos);
}

TEST(DecideHypotheses, OtherScenesStayAsTheyAre) {
  SyntheticScene wall = Wall("window:2", 0);
  const Scene before = wall.scene;
  EXPECT_TRUE(Decide(&wall.scene).empty());
  EXPECT_TRUE(wall.scene == before);
}

// Counts the lines of the triplets that it is asked about.
class LineCounter : public ScaleEstimator {
 public:
  LineCounter() : ScaleEstimator({}) {}
  mutable std::atomic<int> num_asked = 0;
  mutable std::atomic<int> num_lines = 0;

 protected:
  Result<ScaleRatio> Judge(const TripletView& triplet,
                           const TripletEvidence&) const override {
    ++num_asked;
    num_lines += static_cast<int>(triplet.lines.size());
    ScaleRatio ratio;
    ratio.views = triplet.views;
    return ratio;
  }
};

TEST(DecideHypotheses, TripletsSeeTheLineTracks) {
  SyntheticScene wall = Wall("chain", 0);
  PutWrongMotionFirst({2, 3}, &wall);
  Scene& scene = wall.scene;
  Track everything;
  for (const auto& [view, features] : scene.features) {
    for (FeatureIndex n = 0; n < features.segments.size(); ++n) {
      everything.push_back({view, n});
    }
  }
  scene.line_tracks = {{0, everything}};
  const LineCounter estimator;
  ASSERT_TRUE(DecideHypotheses(&scene, estimator, PoseOptions(), RunContext()));
  EXPECT_GT(estimator.num_asked, 0);
  EXPECT_EQ(estimator.num_lines, estimator.num_asked);
}

TEST(DecideHypotheses, IsTheSameForAnyNumberOfThreads) {
  SyntheticScene one = Wall("chain", 2);
  PutWrongMotionFirst({1, 2}, &one);
  PutWrongMotionFirst({2, 3}, &one);
  SyntheticScene two = one;
  const auto a = Decide(&one.scene, 1), b = Decide(&two.scene, 2);
  EXPECT_TRUE(one.scene == two.scene);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].margin, b[n].margin);
  }
}

TEST(DecideHypotheses, IsPartOfSolvingAndOfItsSummary) {
  SyntheticScene wall = Wall("chain", 3);
  Scene unambiguous = wall.scene;
  PutWrongMotionFirst({2, 3}, &wall);
  StageLog stages;
  RunSummary summary;
  for (Scene* scene : {&unambiguous, &wall.scene}) {
    auto result = SolveScene(scene, SolveOptions(), RunContext(), &stages);
    ASSERT_TRUE(result) << result.error().ToString();
    summary.solve = std::move(*result);
  }
  EXPECT_TRUE(wall.scene == unambiguous);
  EXPECT_LT(EvaluatePoses(wall.scene, wall.true_poses).position.max, 0.2);
  const std::string json = ToJson(summary, wall.scene);
  for (const char* member :
       {"\"decided_by_triplets\": 1", "\"decided_by_structure\": 0",
        "\"undecided\": 0", "\"decided_by\": \"triplets\"",
        "\"replaced\": true"}) {
    EXPECT_NE(json.find(member), std::string::npos) << member;
  }
}

/// Two views of one wall, which two motions explain, as a scene and its
/// matches.
Scene AmbiguousPair(std::map<ViewPair, PairMatches>* matches) {
  testing::TwoViewSceneOptions options;
  options.planar = true;
  options.noise_px = 0.3;
  options.cam2_from_cam1 = {RotationFromAngleAxis(Vec3(0.1, -0.1, 0)),
                            Vec3(0, 0.3, -1).normalized()};
  const testing::TwoViewScene views = testing::MakeTwoViewScene(options, 0);
  Scene scene;
  Intrinsic& intrinsic = scene.intrinsics[0];
  intrinsic.width_px = 1600;
  intrinsic.height_px = 1200;
  intrinsic.fx_px = intrinsic.fy_px = testing::kFocalPx;
  intrinsic.principal_point_px = Vec2(800, 600);
  for (const std::uint32_t id : {0u, 1u}) {
    View& view = scene.views[id];
    view.filename = std::to_string(id) + ".jpg";
    view.width_px = intrinsic.width_px;
    view.height_px = intrinsic.height_px;
    view.intrinsic_id = 0;
    view.pose_id = id;
    const auto& points = (id == 0 ? views.features1 : views.features2).points;
    for (const Vec3& x : points) {
      scene.features[id].points_px.push_back(intrinsic.Project(x));
    }
  }
  (*matches)[{0, 1}].points = views.matches;
  return scene;
}

TEST(EstimateRelativePoses, KeepsBothMotionsOfAPlane) {
  std::map<ViewPair, PairMatches> matches;
  Scene scene = AmbiguousPair(&matches);
  const auto reports = EstimateRelativePoses(&scene, matches, nullptr,
                                             RelativePoseOptions(), {});
  ASSERT_TRUE(reports) << reports.error().ToString();
  ASSERT_TRUE(reports->front().accepted) << reports->front().reason;
  EXPECT_EQ(reports->front().geometry, "ambiguous_plane");
  const RelativePose estimated = scene.relative_poses.at({0, 1});
  ASSERT_EQ(estimated.alternatives.size(), 1u);
  EXPECT_GT(RotationAngleBetween(estimated.rotation,
                                 estimated.alternatives[0].rotation),
            RadFromDeg(3));
  EXPECT_TRUE(estimated.alternatives[0].covariance.has_value());

  // Refining moves both a little, and keeps both.
  ASSERT_TRUE(RefineRelativePoses(&scene, {}, RelativePoseOptions(), {}));
  const RelativePose& refined = scene.relative_poses.at({0, 1});
  ASSERT_EQ(refined.alternatives.size(), 1u);
  EXPECT_LT(RotationAngleBetween(refined.rotation, estimated.rotation),
            RadFromDeg(0.5));
  EXPECT_LT(RotationAngleBetween(refined.alternatives[0].rotation,
                                 estimated.alternatives[0].rotation),
            RadFromDeg(0.5));
}

TEST(RefineRelativePoses, AnAlternativeIsNotTurnedIntoThePose) {
  std::map<ViewPair, PairMatches> matches;
  Scene scene = AmbiguousPair(&matches);
  ASSERT_TRUE(EstimateRelativePoses(&scene, matches, nullptr,
                                    RelativePoseOptions(), {}));
  RelativePose& pose = scene.relative_poses.at({0, 1});
  // One that refining would make the pose's own motion, and that motion.
  AlternativeMotion near = pose.alternatives[0], same = near;
  near.rotation =
      RotationFromAngleAxis(Vec3(0, RadFromDeg(1), 0)) * pose.rotation;
  near.direction = same.direction = pose.direction;
  same.rotation = pose.rotation;
  pose.alternatives = {near, same};
  ASSERT_TRUE(RefineRelativePoses(&scene, {}, RelativePoseOptions(), {}));
  EXPECT_EQ(pose.alternatives, std::vector<AlternativeMotion>{near});
}

}  // namespace
}  // namespace lowlap
