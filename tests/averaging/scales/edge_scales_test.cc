#include "lowlap/averaging/scales/internal/edge_scales.h"

#include <gtest/gtest.h>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(EdgeScales, ChainIsTheRecursion) {
  const RandomProblem made =
      MakeRandomProblem(5, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}}, 1);
  const EdgeScales chain = ChainEdgeScales(made.problem);
  const auto averaged = AverageEdgeScales(made.problem);
  ASSERT_TRUE(averaged);
  for (std::size_t e = 0; e < 4; ++e) {
    EXPECT_NEAR(chain.log_length[e], made.TrueLogRatio(0, e), 1e-12);
    EXPECT_NEAR(averaged->log_length[e], made.TrueLogRatio(0, e), 1e-12);
    EXPECT_EQ(averaged->component[e], 0u);
  }
}

TEST(EdgeScales, LoopSharesItsClosingError) {
  RandomProblem made = MakeRandomProblem(
      4, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, 2, /*with_ratios=*/false);
  for (std::size_t e = 0; e < 4; ++e) made.AddRatio(e, (e + 1) % 4, 0.004);
  const auto averaged = AverageEdgeScales(made.problem);
  ASSERT_TRUE(averaged);
  for (const double r : averaged->normalised_residuals) {
    EXPECT_NEAR(r, -0.4, 1e-9);
  }
}

TEST(EdgeScales, AWrongRatioIsForgotten) {
  Edges edges;
  for (std::size_t n = 0; n < 12; ++n) {
    edges.push_back({n, (n + 1) % 12});
    edges.push_back({n, (n + 2) % 12});
  }
  RandomProblem made = MakeRandomProblem(12, edges, 3);
  for (std::size_t r = 0; r < made.problem.ratios.size(); r += 6) {
    made.problem.ratios[r].log_ratio += 1.7;
    made.problem.ratios[r].log10_nfa = -1;
  }
  const auto averaged = AverageEdgeScales(made.problem);
  ASSERT_TRUE(averaged);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    EXPECT_NEAR(averaged->log_length[e], made.TrueLogRatio(0, e), 1e-3);
  }
}

TEST(EdgeScales, EdgesWithoutRatioStandAlone) {
  RandomProblem made = MakeRandomProblem(4, Edges{{0, 1}, {1, 2}, {2, 3}}, 4,
                                         /*with_ratios=*/false);
  made.AddRatio(0, 2);
  const auto averaged = AverageEdgeScales(made.problem);
  ASSERT_TRUE(averaged);
  EXPECT_EQ(averaged->component[0], averaged->component[2]);
  EXPECT_NE(averaged->component[0], averaged->component[1]);
}

}  // namespace
}  // namespace lowlap
