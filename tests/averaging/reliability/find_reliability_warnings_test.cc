#include "lowlap/averaging/reliability/internal/find_reliability_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "averaging/reliability/well_measured_scene.h"
#include "lowlap/averaging/reliability/internal/pose_warnings.h"
#include "lowlap/averaging/scene_poses.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<ReliabilityWarning> WarningsOf(Scene scene) {
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  EXPECT_TRUE(summary);
  return summary ? summary->reliability_warnings
                 : std::vector<ReliabilityWarning>();
}

std::vector<ReliabilityWarning> WarningsOf(const Scene& scene,
                                           const TranslationProblem& problem,
                                           const TranslationSolution& solution,
                                           FirmEvidence* firm) {
  return FindReliabilityWarnings(
      scene, FindAgreement(scene, problem, solution, {}, {}), {}, firm);
}

TEST(ReliabilityWarnings, NoneWhereAllIsWell) {
  for (const char* pairs : {"chain", "cycle", "window:3"}) {
    EXPECT_THAT(WarningsOf(WellMeasuredScene(pairs).scene), IsEmpty()) << pairs;
  }
}

TEST(ReliabilityWarnings, NoneForOneWrongRelativePoseOfMany) {
  SyntheticScene synthetic = WellMeasuredScene("window:3");
  RelativePose& wrong = synthetic.scene.relative_poses.at({3, 5});
  wrong.direction = -wrong.direction;
  EXPECT_THAT(WarningsOf(synthetic.scene), IsEmpty());
}

TEST(ReliabilityWarnings, AViewThatItsRelativePosesContradict) {
  const SyntheticScene synthetic = WellMeasuredScene("window:3");
  TranslationSolution solution = TrueCenters(synthetic);
  const TranslationProblem problem =
      MakeTranslationProblem(synthetic.scene, TrueRotations(synthetic), {});
  FirmEvidence firm;
  EXPECT_THAT(WarningsOf(synthetic.scene, problem, solution, &firm), IsEmpty());
  EXPECT_EQ(firm.edges.size(), problem.edges.size());

  const Vec3 baseline =
      solution.center_in_world[5] - solution.center_in_world[4];
  solution.center_in_world[4] +=
      0.3 * baseline.unitOrthogonal() * baseline.norm();
  const auto warnings = WarningsOf(synthetic.scene, problem, solution, &firm);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kContradictedPoses);
  EXPECT_THAT(warnings[0].views, ElementsAre(4));
  EXPECT_THAT(warnings[0].against, Contains(ViewPair{4, 5}));
}

// The points of one plane leave two motions, of which nothing tells the right.
TEST(ReliabilityWarnings, ViewsThatHangOnOneOfTwoMotions) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  RelativePose& last = synthetic.scene.relative_poses.at({6, 7});
  last.alternatives.push_back({last.rotation, -last.direction, {}, {}});
  auto warnings = WarningsOf(synthetic.scene);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kUntoldPoses);
  EXPECT_THAT(warnings[0].views, ElementsAre(7));
  EXPECT_THAT(warnings[0].untold, ElementsAre(ViewPair{6, 7}));

  // Others hold the view.
  synthetic = WellMeasuredScene("window:3");
  RelativePose& one = synthetic.scene.relative_poses.at({6, 7});
  one.alternatives.push_back({one.rotation, -one.direction, {}, {}});
  EXPECT_THAT(WarningsOf(synthetic.scene), IsEmpty());
}

// All its directions are off alike: what is usual is no measure here.
TEST(ReliabilityWarnings, ATriangleWhoseDirectionsContradictEachOther) {
  SyntheticOptions options;
  options.num_views = 3;
  options.pairs = "all";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  Scene& scene = synthetic.scene;
  scene.scale_ratios.clear();
  for (auto& entry : scene.relative_poses) entry.second.log10_nfa = -100;
  EXPECT_THAT(WarningsOf(scene), IsEmpty());
  const auto center = [&](ViewId view) {
    return synthetic.true_poses.at(view).center;
  };
  const Vec3 off_plane_in_world =
      (center(1) - center(0)).cross(center(2) - center(0)).normalized();
  RelativePose& wrong = scene.relative_poses.at({0, 2});
  wrong.direction =
      std::cos(RadFromDeg(15)) * wrong.direction +
      std::sin(RadFromDeg(15)) *
          (synthetic.true_poses.at(2).rotation * off_plane_in_world);
  std::set<ViewId> named;
  for (const ReliabilityWarning& warning : WarningsOf(scene)) {
    named.insert(warning.views.begin(), warning.views.end());
  }
  EXPECT_THAT(named, ElementsAre(0, 1, 2));
}

TEST(ReliabilityWarnings, TwoViewsThatTwoMotionsExplain) {
  SyntheticOptions options;
  options.num_views = 2;
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  RelativePose& only = synthetic.scene.relative_poses.at({0, 1});
  only.log10_nfa = -100;
  EXPECT_THAT(WarningsOf(synthetic.scene), IsEmpty());
  only.alternatives.push_back({only.rotation, -only.direction, {}, {}});
  const auto warnings = WarningsOf(synthetic.scene);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].views, ElementsAre(0, 1));
}

TEST(ReliabilityWarnings, ViewsThatHangOnAWeakRatio) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  FindRatio({3, 4, 5}, &synthetic.scene)->log10_nfa = -1;
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->num_placed, 8);
  ASSERT_EQ(summary->reliability_warnings.size(), 1u);
  EXPECT_EQ(summary->reliability_warnings[0].reason, WarningReason::kWeakScale);
  EXPECT_THAT(summary->reliability_warnings[0].views, ElementsAre(5, 6, 7));
  EXPECT_THAT(summary->reliability_warnings[0].ratios,
              ElementsAre(ViewTriplet{3, 4, 5}));
  EXPECT_TRUE(summary->IsDoubtful());
  EXPECT_THAT(PoseWarnings(*summary, synthetic.scene),
              Contains(HasSubstr("only weak scale ratios join them")));
}

TEST(ReliabilityWarnings, AllViewsWhereNoPartIsMostOfThem) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  FindRatio({2, 3, 4}, &synthetic.scene)->log10_nfa = -1;
  FindRatio({4, 5, 6}, &synthetic.scene)->log10_nfa = -1;
  const auto warnings = WarningsOf(synthetic.scene);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kWeakScale);
  EXPECT_EQ(warnings[0].views.size(), 8u);
}

// Views 0 to 3 and 3 to 6: four are most of seven, but so are the other four.
TEST(ReliabilityWarnings, AllViewsOfTwoPartsThatAreAsLarge) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  synthetic.scene.relative_poses.erase({6, 7});
  FindRatio({2, 3, 4}, &synthetic.scene)->log10_nfa = -1;
  const auto warnings = WarningsOf(synthetic.scene);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kWeakScale);
  EXPECT_THAT(warnings[0].views, ElementsAre(0, 1, 2, 3, 4, 5, 6));
}

TEST(ReliabilityWarnings, NoViewIsNamedTwice) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) ratio.log10_nfa = -1;
  std::vector<ViewId> named;
  for (const ReliabilityWarning& warning : WarningsOf(synthetic.scene)) {
    named.insert(named.end(), warning.views.begin(), warning.views.end());
  }
  std::sort(named.begin(), named.end());
  EXPECT_EQ(std::adjacent_find(named.begin(), named.end()), named.end());
  EXPECT_EQ(named.size(), 8u);
}

TEST(ReliabilityWarnings, AWeakRatioBesideStrongOnesIsNoWarning) {
  SyntheticScene synthetic = WellMeasuredScene("window:2");
  FindRatio({3, 4, 5}, &synthetic.scene)->log10_nfa = -1;
  EXPECT_THAT(WarningsOf(synthetic.scene), IsEmpty());
}

// Triangles 0-1-2-... and 4-...-7 that meet in view 4 alone, where one ratio
// says something else than the others.
TEST(ReliabilityWarnings, RatiosAcrossOneCameraThatDisagree) {
  SyntheticScene synthetic = WellMeasuredScene("window:2");
  Scene& scene = synthetic.scene;
  scene.relative_poses.erase({3, 5});
  scene.scale_ratios.erase(
      std::remove_if(scene.scale_ratios.begin(), scene.scale_ratios.end(),
                     [&](const ScaleRatio& ratio) {
                       const ViewTriplet& v = ratio.views;
                       return !scene.FindRelativePose(v.first, v.middle) ||
                              !scene.FindRelativePose(v.middle, v.last);
                     }),
      scene.scale_ratios.end());
  EXPECT_THAT(WarningsOf(scene), IsEmpty());

  for (const ViewTriplet& views :
       {ViewTriplet{3, 4, 5}, ViewTriplet{2, 4, 6}}) {
    FindRatio(views, &scene)->log_ratio += 0.7;
  }
  const auto warnings = WarningsOf(scene);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kContradictedRatios);
  EXPECT_THAT(warnings[0].views, ElementsAre(5, 6, 7));
}

// In a chain nothing confirms a relative pose but its own matches.
TEST(ReliabilityWarnings, ViewsThatHangOnAnUntoldRelativePose) {
  for (const char* pairs : {"chain", "window:2"}) {
    SyntheticScene synthetic = WellMeasuredScene(pairs);
    auto rotations =
        AverageSceneRotations(synthetic.scene, PoseOptions(), RunContext());
    ASSERT_TRUE(rotations);
    MatchVerdicts verdicts;
    verdicts.untold = {{4, 5}};
    AddMatchVerdicts(verdicts, &*rotations);
    const auto summary = SolveScenePoses(&synthetic.scene, *rotations,
                                         PoseOptions(), RunContext());
    ASSERT_TRUE(summary);
    if (std::string(pairs) == "window:2") {
      EXPECT_THAT(summary->reliability_warnings, IsEmpty());
      continue;
    }
    ASSERT_EQ(summary->reliability_warnings.size(), 1u);
    EXPECT_EQ(summary->reliability_warnings[0].reason,
              WarningReason::kUntoldPoses);
    EXPECT_THAT(summary->reliability_warnings[0].views, ElementsAre(5, 6, 7));
    EXPECT_THAT(PoseWarnings(*summary, synthetic.scene),
                Contains(HasSubstr("too few matches to tell")));
  }
}

// Either of two untold relative poses would hold the last view by a ratio.
TEST(ReliabilityWarnings, WeakRatiosConfirmNoUntoldPose) {
  for (const bool is_weak : {false, true}) {
    SyntheticScene synthetic = WellMeasuredScene("window:2");
    for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
      const ViewTriplet& v = ratio.views;
      if (is_weak && (v.first == ViewId(7) || v.last == ViewId(7))) {
        ratio.log10_nfa = -1;
      }
    }
    auto rotations =
        AverageSceneRotations(synthetic.scene, PoseOptions(), RunContext());
    ASSERT_TRUE(rotations);
    MatchVerdicts verdicts;
    verdicts.untold = {{5, 7}, {6, 7}};
    AddMatchVerdicts(verdicts, &*rotations);
    const auto summary = SolveScenePoses(&synthetic.scene, *rotations,
                                         PoseOptions(), RunContext());
    ASSERT_TRUE(summary);
    if (!is_weak) {
      EXPECT_THAT(summary->reliability_warnings, IsEmpty());
      continue;
    }
    ASSERT_EQ(summary->reliability_warnings.size(), 1u);
    EXPECT_EQ(summary->reliability_warnings[0].reason,
              WarningReason::kUntoldPoses);
    EXPECT_THAT(summary->reliability_warnings[0].views, ElementsAre(7));
  }
}

// Relative poses that fit anything do not confirm each other.
TEST(ReliabilityWarnings, ViewsThatHangOnPosesThatAreHardlyDetermined) {
  for (const std::vector<ViewPair>& vague :
       {std::vector<ViewPair>{{6, 7}}, {{5, 7}, {6, 7}}}) {
    SyntheticScene synthetic = WellMeasuredScene("window:2");
    MakeVague(vague, &synthetic.scene);
    const auto warnings = WarningsOf(synthetic.scene);
    if (vague.size() == 1) {
      EXPECT_THAT(warnings, IsEmpty());
      continue;
    }
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].reason, WarningReason::kUntoldPoses);
    EXPECT_THAT(warnings[0].views, ElementsAre(7));
    EXPECT_THAT(warnings[0].untold, ElementsAreArray(vague));
  }
}

// Things that look alike do so in every pair that sees them.
TEST(ReliabilityWarnings, ViewsThatHangOnThingsThatMayOnlyLookAlike) {
  for (const std::vector<ViewPair>& weak :
       {std::vector<ViewPair>{{6, 7}}, {{5, 7}, {6, 7}}}) {
    SyntheticScene synthetic = WellMeasuredScene("window:2");
    for (const ViewPair& views : weak) {
      synthetic.scene.relative_poses.at(views).weakness =
          PoseWeakness::kSurroundings;
    }
    const auto warnings = WarningsOf(synthetic.scene);
    if (weak.size() == 1) {
      EXPECT_THAT(warnings, IsEmpty());
      continue;
    }
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].reason, WarningReason::kUntoldPoses);
    EXPECT_THAT(warnings[0].views, ElementsAre(7));
    EXPECT_THAT(warnings[0].untold, ElementsAreArray(weak));
  }
}

// The first view hangs on a weak ratio, whatever its relative pose is worth.
TEST(ReliabilityWarnings, OnlyTheRelativePosesOfTheNamedViewsAreListed) {
  SyntheticScene synthetic = WellMeasuredScene("window:2");
  Scene& scene = synthetic.scene;
  scene.relative_poses.erase({0, 2});
  for (ScaleRatio& ratio : scene.scale_ratios) {
    const ViewTriplet& v = ratio.views;
    if (v.first == ViewId(0) || v.last == ViewId(0)) ratio.log10_nfa = -1;
  }
  MakeVague({{0, 1}, {5, 7}, {6, 7}}, &scene);
  const auto warnings = WarningsOf(scene);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kUntoldPoses);
  EXPECT_THAT(warnings[0].views, ElementsAre(7));
  EXPECT_THAT(warnings[0].untold, ElementsAre(ViewPair{5, 7}, ViewPair{6, 7}));
  EXPECT_EQ(warnings[1].reason, WarningReason::kWeakScale);
  EXPECT_THAT(warnings[1].views, ElementsAre(0));
}

// Two views fit any relative pose; that there were to be more says that
// something is wrong.
TEST(ReliabilityWarnings, TwoViewsThatAreLeftOfMore) {
  for (const int num_views : {2, 8}) {
    SyntheticScene synthetic = WellMeasuredScene("chain");
    Scene& scene = synthetic.scene;
    for (auto it = scene.relative_poses.begin();
         it != scene.relative_poses.end();) {
      it = it->first == ViewPair{0, 1} ? std::next(it)
                                       : scene.relative_poses.erase(it);
    }
    scene.scale_ratios.clear();
    if (num_views == 2) scene = WithoutViews(scene, {2, 3, 4, 5, 6, 7});
    const auto warnings = WarningsOf(scene);
    if (num_views == 2) {
      EXPECT_THAT(warnings, IsEmpty());
      continue;
    }
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].reason, WarningReason::kUnheld);
    EXPECT_THAT(warnings[0].views, ElementsAre(0, 1));
  }
}

// Nothing is left that holds even two views.
TEST(ReliabilityWarnings, AllViewsIfNoRelativePoseIsTold) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  auto rotations =
      AverageSceneRotations(synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(rotations);
  MatchVerdicts verdicts;
  for (const auto& entry : synthetic.scene.relative_poses) {
    verdicts.untold.push_back(entry.first);
  }
  AddMatchVerdicts(verdicts, &*rotations);
  const auto summary = SolveScenePoses(&synthetic.scene, *rotations,
                                       PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->num_placed, 8);
  ASSERT_EQ(summary->reliability_warnings.size(), 1u);
  EXPECT_EQ(summary->reliability_warnings[0].reason,
            WarningReason::kUntoldPoses);
  EXPECT_EQ(summary->reliability_warnings[0].views.size(), 8u);
}

// Two groups that share camera 4 alone, and no ratio across it: what joined
// them otherwise has been left out.
TEST(ReliabilityWarnings, GroupsAtOneCameraWithoutARatioThatAgrees) {
  SyntheticScene synthetic = WellMeasuredScene("window:2");
  Scene& scene = synthetic.scene;
  scene.relative_poses.erase({3, 5});
  // Else the walk past view 2 is straight, as far as directions tell.
  StatePreciseDirections(&scene);
  const auto rotations = TrueRotations(synthetic);
  TranslationSolution solution = TrueCenters(synthetic);
  // Twice the size beyond camera 4.
  const Vec3 hinge = synthetic.true_poses.at(4).center;
  for (std::size_t n = 5; n < solution.center_in_world.size(); ++n) {
    solution.center_in_world[n] += solution.center_in_world[n] - hinge;
  }
  const TranslationProblem problem =
      MakeTranslationProblem(scene, rotations, {});
  EXPECT_FALSE(
      FindAgreement(scene, problem, solution, {}, {}).rejected_ratios.empty());
  FirmEvidence firm;
  const auto warnings = WarningsOf(scene, problem, solution, &firm);
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings[0].reason, WarningReason::kContradictedRatios);
  EXPECT_THAT(warnings[0].views, ElementsAre(5, 6, 7));

  // Without any ratio nothing holds them either.
  scene.scale_ratios.clear();
  const auto without = WarningsOf(
      scene, MakeTranslationProblem(scene, rotations, {}), solution, &firm);
  ASSERT_EQ(without.size(), 1u);
  EXPECT_EQ(without[0].reason, WarningReason::kUnheld);
  EXPECT_THAT(without[0].views, ElementsAre(5, 6, 7));
}

}  // namespace
}  // namespace lowlap
