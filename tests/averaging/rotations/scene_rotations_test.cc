#include "lowlap/averaging/rotations/scene_rotations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "averaging/rotations/random_rotation_graph.h"

namespace lowlap {
namespace {

constexpr double kReach = 5.0;

SceneRotations Average(const RotationGraph& graph) {
  const auto result =
      AverageSceneRotations(ToScene(graph), RotationAveragingOptions(), kReach);
  EXPECT_TRUE(result);
  return result ? *result : SceneRotations();
}

std::set<ViewPair> Outliers(const SceneRotations& rotations) {
  std::set<ViewPair> pairs;
  for (const OutlierEdge& outlier : rotations.outliers) {
    pairs.insert(outlier.views);
  }
  return pairs;
}

double WorstErrorRad(const RotationGraph& graph,
                     const SceneRotations& rotations) {
  const auto& [anchor, reference] = *rotations.cam_from_world.begin();
  double worst = 0;
  for (const auto& [view, rotation] : rotations.cam_from_world) {
    worst = std::max(
        worst, RotationAngleBetween(
                   graph.truth[view.value()] *
                       graph.truth[anchor.value()].transpose() * reference,
                   rotation));
  }
  return worst;
}

RotationGraph Views(std::size_t count, std::uint64_t seed) {
  RotationGraph graph;
  Random random(seed);
  for (std::size_t n = 0; n < count; ++n) {
    graph.truth.push_back(RandomRotation(&random));
  }
  return graph;
}

void AddWithEvidence(RotationGraph* graph, std::size_t first,
                     std::size_t second, const Vec3& error, double evidence) {
  graph->Add(first, second, error, error.norm() > 0);
  graph->measurements.back().cost = -evidence;
}

TEST(AverageSceneRotations, FalseEdgesAreNamedUpToHalfOfAll) {
  for (const double share : {0.1, 0.3, 0.5}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const RotationGraph graph = MakeRotationGraph(20, 6, share, 1.0, seed);
      const SceneRotations rotations = Average(graph);
      EXPECT_LT(WorstErrorRad(graph, rotations), 0.03)
          << share << " seed " << seed;
      const std::set<ViewPair> outliers = Outliers(rotations);
      for (const auto& [views, pose] : ToScene(graph).relative_poses) {
        const double error = RotationAngleBetween(
            pose.rotation, graph.truth[views.second.value()] *
                               graph.truth[views.first.value()].transpose());
        const bool placed = rotations.cam_from_world.count(views.first) > 0 &&
                            rotations.cam_from_world.count(views.second) > 0;
        if (error > 0.1 && placed) {
          EXPECT_TRUE(outliers.count(views)) << views.first << views.second;
        }
      }
    }
  }
}

TEST(AverageSceneRotations, CoherentFalseEdgesLoseToTheMajority) {
  // Views 0..5 see one facade and 6..11 its twin: every false edge between
  // the halves has the same wrong turn, so they confirm each other.
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RotationGraph graph = MakeRotationGraph(12, 4, 0.0, 1.0, seed);
    const Mat3 turn = RotationFromAngleAxis(Vec3(0, 1.2, 0));
    int num_false = 0;
    for (const auto& [a, b] :
         {std::pair<std::size_t, std::size_t>{0, 6}, {1, 7}, {0, 7}, {1, 6}}) {
      RotationMeasurement m;
      m.first = a;
      m.second = b;
      m.stddev_rad = 0.003;
      m.cost = -40;
      m.second_from_first = graph.truth[b] * turn * graph.truth[a].transpose();
      graph.measurements.push_back(m);
      graph.is_false.push_back(true);
      ++num_false;
    }
    const SceneRotations rotations = Average(graph);
    EXPECT_LT(WorstErrorRad(graph, rotations), 0.02) << seed;
    EXPECT_EQ(Outliers(rotations).size(), static_cast<std::size_t>(num_false))
        << seed;
  }
}

TEST(AverageSceneRotations, AViewWithFalseEdgesOnlyIsNotPlaced) {
  RotationGraph graph = Views(7, 1);
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 6; ++b) {
      AddWithEvidence(&graph, a, b, Vec3::Zero(), 50);
    }
  }
  AddWithEvidence(&graph, 0, 6, Vec3(0.1, 0, 0), 90);
  AddWithEvidence(&graph, 1, 6, Vec3(0, 0.15, 0), 60);
  AddWithEvidence(&graph, 2, 6, Vec3(0, 0.05, -0.1), 40);
  const SceneRotations rotations = Average(graph);
  EXPECT_EQ(rotations.cam_from_world.count(6), 0u);
  EXPECT_EQ(rotations.cam_from_world.size(), 6u);
  EXPECT_EQ(Outliers(rotations).size(), 3u);
  EXPECT_LT(WorstErrorRad(graph, rotations), 1e-9);
}

TEST(AverageSceneRotations, WeakContradictionsLeaveALinkInPlaceButContested) {
  RotationGraph graph = Views(7, 2);
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 6; ++b) {
      AddWithEvidence(&graph, a, b, Vec3::Zero(), 50);
    }
  }
  AddWithEvidence(&graph, 0, 6, Vec3::Zero(), 90);
  AddWithEvidence(&graph, 1, 6, Vec3(0, 0.3, 0), 4);
  const SceneRotations rotations = Average(graph);
  EXPECT_EQ(rotations.cam_from_world.count(6), 1u);
  EXPECT_EQ(Outliers(rotations), (std::set<ViewPair>{{1, 6}}));
  ASSERT_EQ(rotations.contested.size(), 1u);
  EXPECT_EQ(rotations.contested[0].edge, (ViewPair{0, 6}));
  EXPECT_EQ(rotations.contested[0].contradictions,
            (std::vector<ViewPair>{{1, 6}}));
  EXPECT_EQ(rotations.contested[0].views, (std::vector<ViewId>{6}));
  EXPECT_EQ(rotations.unchecked, (std::vector<ViewPair>{{0, 6}}));
}

// Three false links of one mind win against two, unless third views tell.
TEST(AverageSceneRotations, WhatThirdViewsOutweighHasNoPart) {
  RotationGraph graph = Views(10, 5);
  for (const std::size_t begin : {0u, 5u}) {
    for (std::size_t n = 0; n < 5; ++n) {
      graph.Add(begin + n, begin + (n + 1) % 5, Vec3::Zero(), false);
      graph.Add(begin + n, begin + (n + 2) % 5, Vec3::Zero(), false);
    }
  }
  graph.Add(3, 5, Vec3::Zero(), false);
  graph.Add(4, 6, Vec3::Zero(), false);
  ThirdViewVerdicts verdicts;
  for (std::size_t n = 0; n < 3; ++n) {
    const Mat3 turn = RotationFromAngleAxis(kPi * Vec3::UnitY());
    graph.Add(n, n + 7, Vec3::Zero(), true);
    graph.measurements.back().second_from_first =
        graph.truth[n + 7] * turn * graph.truth[n].transpose();
    verdicts.outweighed.insert(
        {static_cast<ViewId>(n), static_cast<ViewId>(n + 7)});
  }
  EXPECT_GT(WorstErrorRad(graph, Average(graph)), 1);

  const auto told =
      AverageSceneRotations(ToScene(graph), RotationAveragingOptions(), kReach,
                            0, RunContext(), verdicts);
  ASSERT_TRUE(told);
  EXPECT_LT(WorstErrorRad(graph, *told), 1e-6);
  EXPECT_EQ(Outliers(*told), verdicts.outweighed);
  for (const OutlierEdge& outlier : told->outliers) {
    EXPECT_EQ(outlier.reason, OutlierReason::kOutweighed);
  }
  EXPECT_TRUE(told->contested.empty());
}

TEST(AverageSceneRotations, AChainIsKeptAndListedAsUnchecked) {
  RotationGraph graph = Views(5, 3);
  for (std::size_t n = 0; n + 1 < 5; ++n) {
    AddWithEvidence(&graph, n, n + 1, Vec3::Zero(), 20);
  }
  const SceneRotations rotations = Average(graph);
  EXPECT_TRUE(rotations.outliers.empty());
  EXPECT_TRUE(rotations.loops.empty());
  EXPECT_EQ(rotations.unchecked.size(), 4u);
}

TEST(AverageSceneRotations, ASingleLoopSharesASmallClosingError) {
  RotationGraph graph = Views(12, 4);
  for (std::size_t n = 0; n < 12; ++n) {
    // One edge is off by 8 of its deviations: drift, or a poor pair.
    AddWithEvidence(&graph, n, (n + 1) % 12,
                    n == 7 ? Vec3(0.024, 0, 0) : Vec3(0, 0, 0), 20.0 + n);
  }
  const SceneRotations rotations = Average(graph);
  EXPECT_TRUE(rotations.outliers.empty());
  EXPECT_EQ(rotations.cam_from_world.size(), 12u);
  EXPECT_LT(WorstErrorRad(graph, rotations), 0.024);
}

TEST(AverageSceneRotations, ASingleLoopThatDoesNotCloseIsReported) {
  RotationGraph graph = Views(12, 5);
  for (std::size_t n = 0; n < 12; ++n) {
    AddWithEvidence(&graph, n, (n + 1) % 12,
                    n == 7 ? Vec3(0.4, 0, 0) : Vec3(0, 0, 0), n == 7 ? 5 : 50);
  }
  const SceneRotations rotations = Average(graph);
  ASSERT_EQ(rotations.loops.size(), 1u);
  EXPECT_EQ(rotations.loops[0].edges.size(), 12u);
  EXPECT_NEAR(rotations.loops[0].closing_deg, DegFromRad(0.4), 0.1);
  EXPECT_LT(rotations.loops[0].expected_deg, 2);
  ASSERT_TRUE(rotations.loops[0].left_out);
  EXPECT_EQ(*rotations.loops[0].left_out, (ViewPair{7, 8}));
  EXPECT_EQ(rotations.outliers.size(), 1u);
  EXPECT_EQ(rotations.outliers[0].reason, OutlierReason::kOpenLoop);
  EXPECT_EQ(rotations.cam_from_world.size(), 12u);
  EXPECT_LT(WorstErrorRad(graph, rotations), 1e-9);
}

TEST(AverageSceneRotations, IsTheSameEveryTime) {
  const RotationGraph graph = MakeRotationGraph(20, 5, 0.4, 1.0, 9);
  const SceneRotations first = Average(graph), second = Average(graph);
  EXPECT_EQ(Outliers(first), Outliers(second));
  for (const auto& [view, rotation] : first.cam_from_world) {
    EXPECT_EQ(rotation, second.cam_from_world.at(view));
  }
}

TEST(AverageSceneRotations, RefusesAnEmptyScene) {
  EXPECT_EQ(AverageSceneRotations(Scene(), RotationAveragingOptions(), kReach)
                .error()
                .code,
            ErrorCode::kInsufficientData);
}

TEST(OutlierEdge, IsFalseByMoreThanADegreeOrThree) {
  const auto is_false = [](OutlierReason reason, double error_deg) {
    return OutlierEdge{{0, 1}, reason, error_deg}.IsFalse();
  };
  EXPECT_FALSE(is_false(OutlierReason::kRotation, 0.9));
  EXPECT_TRUE(is_false(OutlierReason::kRotation, 1.1));
  EXPECT_FALSE(is_false(OutlierReason::kDirection, 2.9));
  EXPECT_TRUE(is_false(OutlierReason::kDirection, 3.1));
  EXPECT_TRUE(is_false(OutlierReason::kContradicted, 0));
  EXPECT_TRUE(is_false(OutlierReason::kOpenLoop, 0));
  EXPECT_FALSE(is_false(OutlierReason::kMatches, 0));
  EXPECT_TRUE(is_false(OutlierReason::kOutweighed, 0));
  EXPECT_TRUE(is_false(OutlierReason::kLookAlike, 0));
}

}  // namespace
}  // namespace lowlap
