#include "lowlap/averaging/rotations/internal/branch_turns.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "averaging/rotations/random_rotation_graph.h"
#include "lowlap/averaging/rotations/internal/rotation_cost.h"

namespace lowlap {
namespace {

// Two triangles, 0 - 1 - 2 and 3 - 4 - 5, and between the two parts a false
// edge that the given rotations meet, and two right ones.
RotationGraph TwoParts() {
  RotationGraph graph;
  Random random(1);
  for (int n = 0; n < 6; ++n) graph.truth.push_back(RandomRotation(&random));
  for (const auto& [a, b] : {std::pair(0, 1),
                             {1, 2},
                             {0, 2},
                             {3, 4},
                             {4, 5},
                             {3, 5},
                             {5, 0},
                             {1, 4}}) {
    graph.Add(a, b, Vec3::Zero(), false);
  }
  graph.Add(3, 2, Vec3(0, 0.5, 0), true);
  return graph;
}

std::vector<Mat3> MeetingTheFalseEdge(const RotationGraph& graph) {
  const RotationMeasurement& m = graph.measurements.back();
  const Mat3 turn = (m.second_from_first * graph.truth[m.first]).transpose() *
                    graph.truth[m.second];
  std::vector<Mat3> rotations = graph.truth;
  for (std::size_t n = 3; n < 6; ++n) rotations[n] = rotations[n] * turn;
  return rotations;
}

TEST(TurnBranches, TurnsAllThatHangsOnAFalseEdge) {
  const RotationGraph graph = TwoParts();
  std::vector<Mat3> rotations = MeetingTheFalseEdge(graph);
  EXPECT_NEAR(RotationResidual(graph.measurements.back(), rotations).norm(), 0,
              1e-12);
  EXPECT_GT(graph.WorstErrorRad(rotations), 0.4);
  TurnBranches(graph.measurements, &rotations);
  EXPECT_LT(graph.WorstErrorRad(rotations), 1e-12);
}

TEST(TurnBranches, LeavesWhatATrustedMeasurementLeadsTo) {
  RotationGraph graph = TwoParts();
  graph.measurements.back().trusted = true;
  const std::vector<Mat3> given = MeetingTheFalseEdge(graph);
  std::vector<Mat3> rotations = given;
  TurnBranches(graph.measurements, &rotations);
  EXPECT_EQ(rotations, given);
}

TEST(TurnBranches, LowersTheCostAndLeavesAnOptimumAlone) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RotationGraph graph = MakeRotationGraph(30, 4, 0.3, 1.5, seed);
    Random random(seed + 100);
    std::vector<Mat3> rotations;
    for (std::size_t n = 0; n < graph.truth.size(); ++n) {
      rotations.push_back(RandomRotation(&random));
    }
    const double before = RobustCost(graph.measurements, rotations);
    TurnBranches(graph.measurements, &rotations);
    EXPECT_LT(RobustCost(graph.measurements, rotations), before);
  }
  const RotationGraph exact = TwoParts();
  std::vector<Mat3> rotations = exact.truth;
  TurnBranches(exact.measurements, &rotations);
  EXPECT_EQ(rotations, exact.truth);
}

}  // namespace
}  // namespace lowlap
