#include "lowlap/averaging/rotations/internal/cycle_support.h"

#include <gtest/gtest.h>

#include "averaging/rotations/random_rotation_graph.h"

namespace lowlap {
namespace {

TEST(ScoreCycles, ExactMeasurementsHaveNoError) {
  RotationGraph graph;
  Random random(1);
  for (int n = 0; n < 6; ++n) graph.truth.push_back(RandomRotation(&random));
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 6; ++b) {
      graph.Add(a, b, Vec3::Zero(), false);
    }
  }
  const CycleSupport support = ScoreCycles(6, graph.measurements);
  for (std::size_t e = 0; e < graph.measurements.size(); ++e) {
    EXPECT_LT(support.error_rad[e], 1e-7);
    EXPECT_EQ(support.num_cycles[e], 4);
  }
}

TEST(ScoreCycles, TellsTheErrorOfTheOneFalseEdge) {
  RotationGraph graph;
  Random random(2);
  for (int n = 0; n < 6; ++n) graph.truth.push_back(RandomRotation(&random));
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 6; ++b) {
      const bool wrong = a == 1 && b == 4;
      graph.Add(a, b, wrong ? Vec3(0.2, 0, 0) : RandomVector(&random, 0.001),
                wrong);
    }
  }
  const CycleSupport support = ScoreCycles(6, graph.measurements);
  for (std::size_t e = 0; e < graph.measurements.size(); ++e) {
    if (graph.is_false[e]) {
      EXPECT_NEAR(support.error_rad[e], 0.2, 0.01);
    } else {
      EXPECT_LT(support.error_rad[e], 0.01);
    }
  }
}

TEST(ScoreCycles, SeparatesFalseEdgesAtFortyPercent) {
  int misjudged = 0, edges = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RotationGraph graph = MakeRotationGraph(30, 8, 0.4, 1.0, seed);
    const CycleSupport support = ScoreCycles(30, graph.measurements);
    for (std::size_t e = 0; e < graph.measurements.size(); ++e) {
      const double error = RotationAngleBetween(
          graph.measurements[e].second_from_first,
          graph.truth[graph.measurements[e].second] *
              graph.truth[graph.measurements[e].first].transpose());
      ++edges;
      misjudged += (support.error_rad[e] > 0.05) != (error > 0.05) ? 1 : 0;
    }
  }
  EXPECT_LT(misjudged, edges / 50);
}

TEST(ScoreCycles, UsesQuadsWhereThereAreNoTriangles) {
  // A ladder: two rows of views, rungs between them.
  RotationGraph graph;
  Random random(3);
  for (int n = 0; n < 12; ++n) graph.truth.push_back(RandomRotation(&random));
  for (std::size_t n = 0; n + 2 < 12; ++n) {
    const bool wrong = n == 4;
    graph.Add(n, n + 2, wrong ? Vec3(0, 0.3, 0) : Vec3::Zero(), wrong);
  }
  for (std::size_t n = 0; n < 12; n += 2) {
    graph.Add(n, n + 1, Vec3::Zero(), false);
  }
  const CycleSupport support = ScoreCycles(12, graph.measurements);
  EXPECT_NEAR(support.error_rad[4], 0.3, 1e-6);
  EXPECT_GT(support.num_cycles[4], 0);
  EXPECT_LT(support.error_rad[0], 1e-6);
}

TEST(ScoreCycles, KnowsNothingOfATree) {
  RotationGraph graph;
  graph.truth.assign(4, Mat3::Identity());
  graph.Add(0, 1, Vec3::Zero(), false);
  graph.Add(1, 2, Vec3::Zero(), false);
  graph.Add(3, 1, Vec3(1, 0, 0), true);
  const CycleSupport support = ScoreCycles(4, graph.measurements);
  for (const int count : support.num_cycles) EXPECT_EQ(count, 0);
  EXPECT_EQ(support.typical_rad, 0);
}

TEST(ScoreCycles, SomeOfTheTrianglesOfADenseGraphTellEnough) {
  constexpr std::size_t kViews = 140;
  RotationGraph graph;
  Random random(3);
  for (std::size_t n = 0; n < kViews; ++n) {
    graph.truth.push_back(RandomRotation(&random));
  }
  for (std::size_t a = 0; a < kViews; ++a) {
    for (std::size_t b = a + 1; b < kViews; ++b) {
      const bool wrong = random.Uniform() < 0.3;
      graph.Add(a, b,
                wrong ? Vec3(0.3 * RandomVector(&random, 1).normalized())
                      : GaussianVector(&random, 0.003),
                wrong);
    }
  }
  const CycleSupport support = ScoreCycles(kViews, graph.measurements);
  for (std::size_t e = 0; e < graph.measurements.size(); ++e) {
    EXPECT_EQ(support.num_cycles[e], 100);
    EXPECT_EQ(support.error_rad[e] > 0.1, graph.is_false[e]);
  }
}

}  // namespace
}  // namespace lowlap
