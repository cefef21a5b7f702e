#include "lowlap/adjustment/internal/structure/prediction_evidence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "test_scene.h"

namespace lowlap {
namespace {

using test::MakeTestScene;
using test::TestSceneOptions;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

// The views of a test scene are 3, 5, 7, ...
const std::vector<ViewPair> kPairs = {{3, 5}, {5, 9}, {7, 9}, {9, 11}};
const std::vector<ViewTriplet> kTriplets = {{3, 5, 7}, {5, 7, 9}, {7, 9, 11}};

TestSceneOptions Noisy() {
  TestSceneOptions options;
  options.num_views = 5;
  options.noise_px = 0.7;
  options.point_outliers = options.line_outliers = 0.1;
  return options;
}

PredictionEvidence AllEvidence(const Scene& scene) {
  PredictionEvidence evidence =
      FindPredictionEvidence(scene, kPairs, kTriplets);
  EXPECT_THAT(evidence.pairs, SizeIs(kPairs.size()));
  EXPECT_THAT(evidence.triplets, SizeIs(kTriplets.size()));
  return evidence;
}

TEST(PredictionEvidence, OfRightCamerasIsFarBeyondChance) {
  Scene scene = MakeTestScene(Noisy()).scene;
  test::BuildAndAdjust(&scene);
  const PredictionEvidence evidence = AllEvidence(scene);
  for (const auto& [views, log10_nfa] : evidence.pairs) {
    EXPECT_LT(log10_nfa, -20) << views.first << "-" << views.second;
  }
  for (const auto& entry : evidence.triplets) EXPECT_LT(entry.second, -20);
}

TEST(PredictionEvidence, IsOfPointsAloneAndOfLinesAlone) {
  for (const bool of_points : {true, false}) {
    TestSceneOptions options = Noisy();
    (of_points ? options.num_lines : options.num_points) = 0;
    Scene scene = MakeTestScene(options).scene;
    test::BuildAndAdjust(&scene);
    for (const auto& entry : AllEvidence(scene).pairs) {
      EXPECT_LT(entry.second, -10) << of_points;
    }
  }
}

// In one of the views suffices.
TEST(PredictionEvidence, IsNoneOfWhatRepeats) {
  Scene scene = MakeTestScene(Noisy()).scene;
  test::BuildAndAdjust(&scene);
  ViewFeatures& features = scene.features.at(7);
  const auto set_share = [&](std::size_t share) {
    features.repeated_points.resize(features.points_px.size() / share);
    features.repeated_segments.resize(features.segments.size() / share);
    for (auto* repeated :
         {&features.repeated_points, &features.repeated_segments}) {
      std::iota(repeated->begin(), repeated->end(), FeatureIndex{0});
    }
  };
  set_share(3);
  for (const auto& entry : AllEvidence(scene).triplets) {
    EXPECT_LT(entry.second, -10);
  }
  set_share(1);
  const PredictionEvidence evidence = AllEvidence(scene);
  for (const auto& entry : evidence.triplets) EXPECT_EQ(entry.second, 0);
  EXPECT_EQ(evidence.pairs.at({7, 9}), 0);
  EXPECT_THAT(evidence.contradicted, IsEmpty());
}

// Its own features still have places with each of the others.
TEST(PredictionEvidence, OfACameraThatIsElsewhereIsChance) {
  Scene scene = MakeTestScene(Noisy()).scene;
  const PoseId moved = scene.views.at(9).pose_id;
  scene.poses.at(moved).rotation = RotationFromAngleAxis(Vec3(0.3, 0.6, -0.4)) *
                                   scene.poses.at(moved).rotation;
  scene.poses.at(moved).center += Vec3(1, 2, -1);
  StructureOptions options;
  ASSERT_TRUE(BuildStructure(&scene, options, RunContext()));
  const PredictionEvidence evidence = AllEvidence(scene);
  for (const auto& [views, log10_nfa] : evidence.pairs) {
    const bool is_wrong = views.first == ViewId(9) || views.second == ViewId(9);
    if (is_wrong) {
      EXPECT_GT(log10_nfa, -3) << views.first << "-" << views.second;
    } else {
      EXPECT_LT(log10_nfa, -20);
    }
  }
  EXPECT_GT(evidence.triplets.at({5, 7, 9}), -3);
  EXPECT_LT(evidence.triplets.at({3, 5, 7}), -20);
}

// Two cameras fell into one place, where what they share has none: the others
// predict what they see, but not what both see.
TEST(PredictionEvidence, CamerasThatFellTogetherAreContradicted) {
  TestSceneOptions options = Noisy();
  options.max_point_views = options.max_line_views = 3;
  Scene scene = MakeTestScene(options).scene;
  test::BuildAndAdjust(&scene);
  EXPECT_THAT(AllEvidence(scene).contradicted, IsEmpty());
  scene.poses.at(scene.views.at(9).pose_id).center =
      scene.poses.at(scene.views.at(7).pose_id).center;
  ASSERT_TRUE(BuildStructure(&scene, StructureOptions(), RunContext()));
  const PredictionEvidence evidence = AllEvidence(scene);
  EXPECT_EQ(evidence.pairs.at({7, 9}), 0);
  EXPECT_THAT(evidence.contradicted, Contains(ViewPair{7, 9}));
  EXPECT_THAT(evidence.contradicted, Not(Contains(ViewPair{3, 5})));
}

// The adjustment may do its best with what is unrelated.
TEST(PredictionEvidence, OfUnrelatedFeaturesIsChance) {
  int num_meaningful = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    TestSceneOptions options = Noisy();
    options.num_points = options.num_lines = 60;
    options.seed = seed;
    Scene scene = MakeTestScene(options).scene;
    Random random(seed, 1);
    for (auto& entry : scene.features) {
      std::vector<Vec2>& points_px = entry.second.points_px;
      for (std::size_t n = points_px.size(); n > 1; --n) {
        std::swap(points_px[n - 1],
                  points_px[random.Index(static_cast<std::uint32_t>(n))]);
      }
      std::vector<LineSegment>& segments = entry.second.segments;
      for (std::size_t n = segments.size(); n > 1; --n) {
        std::swap(segments[n - 1],
                  segments[random.Index(static_cast<std::uint32_t>(n))]);
      }
    }
    test::BuildAndAdjust(&scene);
    const PredictionEvidence evidence = AllEvidence(scene);
    for (const auto& entry : evidence.pairs) {
      num_meaningful += entry.second < -1;
    }
    for (const auto& entry : evidence.triplets) {
      num_meaningful += entry.second < -1;
    }
  }
  // Of 140, one in ten by chance would be 14.
  EXPECT_LE(num_meaningful, 2);
}

TEST(PredictionEvidence, TwoViewsSayNothing) {
  TestSceneOptions options = Noisy();
  options.max_point_views = options.max_line_views = 2;
  Scene scene = MakeTestScene(options).scene;
  test::BuildAndAdjust(&scene);
  for (const auto& entry : AllEvidence(scene).pairs) {
    EXPECT_EQ(entry.second, 0);
  }
}

TEST(PredictionEvidence, FewSharedTracksSayNothing) {
  TestSceneOptions options = Noisy();
  options.num_points = 6;
  options.num_lines = 0;
  options.point_outliers = 0;
  Scene scene = MakeTestScene(options).scene;
  StructureOptions structure;
  ASSERT_TRUE(BuildStructure(&scene, structure, RunContext()));
  for (const auto& entry : AllEvidence(scene).pairs) {
    EXPECT_EQ(entry.second, 0);
  }
}

TEST(PredictionEvidence, DoesNotDependOnTheWorldsFrame) {
  Scene scene = MakeTestScene(Noisy()).scene;
  test::BuildAndAdjust(&scene);
  const Scene moved = test::Transformed(
      scene, {7.5, RotationFromAngleAxis(Vec3(0.4, -1.1, 0.2)), {3, -2, 9}});
  const PredictionEvidence before = AllEvidence(scene);
  const PredictionEvidence after = AllEvidence(moved);
  for (const auto& [views, log10_nfa] : before.pairs) {
    EXPECT_NEAR(after.pairs.at(views), log10_nfa, 1e-3);
  }
  for (const auto& [views, log10_nfa] : before.triplets) {
    EXPECT_NEAR(after.triplets.at(views), log10_nfa, 1e-3);
  }
}

TEST(PredictionEvidence, ViewsWithoutPosesAreLeftOut) {
  Scene scene = MakeTestScene(Noisy()).scene;
  test::BuildAndAdjust(&scene);
  EXPECT_THAT(FindPredictionEvidence(scene, {}, {}).pairs, IsEmpty());
  scene.poses.erase(scene.views.at(3).pose_id);
  scene.structure.clear();
  scene.line_structure.clear();
  scene.coplanar_pairs.clear();
  const auto evidence = FindPredictionEvidence(scene, kPairs, kTriplets);
  EXPECT_EQ(evidence.pairs.count({3, 5}), 0u);
  EXPECT_EQ(evidence.pairs.at({7, 9}), 0);  // nothing is predicted
  EXPECT_EQ(evidence.triplets.count({3, 5, 7}), 0u);
}

}  // namespace
}  // namespace lowlap
