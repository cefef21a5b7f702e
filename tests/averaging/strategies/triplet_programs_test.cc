#include "lowlap/averaging/strategies/internal/triplet_programs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "averaging/random_problem.h"
#include "lowlap/averaging/strategies/internal/triplet_baselines.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;
using Norm = TripletProgramAverager::Norm;

Edges Band(std::size_t num_views, std::size_t reach) {
  Edges edges;
  for (std::size_t a = 0; a < num_views; ++a) {
    for (std::size_t b = a + 1; b < num_views && b <= a + reach; ++b) {
      edges.push_back({a, b});
    }
  }
  return edges;
}

void AddNoise(double size, std::uint64_t seed, TranslationProblem* problem) {
  Random random(seed);
  for (DirectionEdge& edge : problem->edges) {
    edge.direction_in_world =
        (edge.direction_in_world + RandomVector(&random, size)).normalized();
  }
}

class TripletPrograms : public ::testing::TestWithParam<Norm> {
 protected:
  TranslationSolution Solve(const TranslationProblem& problem) {
    const auto solution =
        TripletProgramAverager(GetParam()).Solve(problem, RunContext());
    EXPECT_TRUE(solution);
    return *solution;
  }
};

INSTANTIATE_TEST_SUITE_P(Both, TripletPrograms,
                         ::testing::Values(Norm::kMaximum, Norm::kSum));

TEST_P(TripletPrograms, ExactWithRatios) {
  const RandomProblem made = MakeRandomProblem(12, Band(12, 3), 1);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 1);
  EXPECT_LT(ErrorOfFirstPart(made, solution), 1e-7);
}

TEST_P(TripletPrograms, ExactFromDirectionsAlone) {
  const RandomProblem made =
      MakeRandomProblem(12, Band(12, 3), 2, /*with_ratios=*/false);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 1);
  EXPECT_LT(ErrorOfFirstPart(made, solution), 1e-7);
}

TEST_P(TripletPrograms, PlacesNoViewOfAChain) {
  const RandomProblem made = MakeRandomProblem(9, Band(9, 1), 3);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 0);
  EXPECT_EQ(solution.component, std::vector<int>(9, -1));
}

TEST_P(TripletPrograms, CentresOnALineNeedRatios) {
  RandomProblem made =
      MakeRandomProblem(7, Band(7, 2), 4, /*with_ratios=*/false);
  for (std::size_t n = 0; n < made.centers.size(); ++n) {
    made.centers[n] = Vec3(1, 2, -1) * std::pow(1.3, n);
  }
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (made.centers[edge.second] - made.centers[edge.first]).normalized();
  }
  EXPECT_EQ(Solve(made.problem).num_components, 0);
  for (std::size_t a = 0; a < made.problem.edges.size(); ++a) {
    for (std::size_t b = a + 1; b < made.problem.edges.size(); ++b) {
      if (made.problem.edges[a].second == made.problem.edges[b].first) {
        made.AddRatio(a, b);
      }
    }
  }
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.component, std::vector<int>(7, 0));
  EXPECT_LT(ErrorOfFirstPart(made, solution), 1e-7);
}

TEST_P(TripletPrograms, TripletsThatMeetInAViewKeepTheirScales) {
  const RandomProblem made = MakeRandomProblem(
      7, Edges{{0, 1}, {1, 2}, {0, 2}, {1, 3}, {2, 3}, {3, 4}, {4, 5}, {3, 5}},
      5);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.component, (std::vector<int>{0, 0, 0, 0, 1, 1, -1}));
}

TEST_P(TripletPrograms, ATripletThatDoesNotCloseIsLeftOut) {
  RandomProblem made = MakeRandomProblem(
      5, Edges{{0, 1}, {1, 2}, {0, 2}, {1, 3}, {2, 3}, {0, 4}, {1, 4}}, 6);
  made.problem.edges[5].direction_in_world *= -1;
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.component, (std::vector<int>{0, 0, 0, 0, -1}));
  EXPECT_LT(ErrorOfFirstPart(made, solution), 1e-7);
}

// The error of centres, with the best scale >= 1 of every triplet.
double Objective(const TranslationProblem& problem,
                 const std::vector<TripletMotion>& triplets,
                 const std::vector<Vec3>& centers, Norm norm) {
  double total = 0;
  for (const TripletMotion& motion : triplets) {
    const auto error = [&](double lambda) {
      double sum = 0, maximum = 0;
      for (int n = 0; n < 3; ++n) {
        const DirectionEdge& edge = problem.edges[motion.edges[n]];
        const Vec3 residual = (centers[edge.second] - centers[edge.first] -
                               lambda * motion.baselines[n])
                                  .cwiseAbs();
        sum += residual.sum();
        maximum = std::max(maximum, residual.maxCoeff());
      }
      return norm == Norm::kMaximum ? maximum : sum;
    };
    double low = 1, high = 50;  // the error is convex in lambda
    while (high - low > 1e-10) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (error(a) < error(b) ? high : low) = error(a) < error(b) ? b : a;
    }
    const double best = error(low);
    total = norm == Norm::kMaximum ? std::max(total, best) : total + best;
  }
  return total;
}

TEST_P(TripletPrograms, NoCentresNearbyAreBetter) {
  // The problem is convex: what nothing nearby betters is the optimum.
  RandomProblem made =
      MakeRandomProblem(6, Band(6, 2), 7, /*with_ratios=*/false);
  AddNoise(0.1, 8, &made.problem);
  TripletProgramOptions options;
  options.max_closure_deg = 45;
  const auto sets = FindTripletBaselines(made.problem, options);
  ASSERT_EQ(sets.size(), 1u);
  const TranslationSolution solution =
      *TripletProgramAverager(GetParam(), options)
           .Solve(made.problem, RunContext());
  ASSERT_EQ(solution.component, std::vector<int>(6, 0));
  const double best =
      Objective(made.problem, sets[0], solution.center_in_world, GetParam());
  EXPECT_GT(best, 1e-4);
  Random random(9);
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<Vec3> other = solution.center_in_world;
    const double size = std::pow(10.0, random.Uniform(-4, 0));
    for (std::size_t n = 1; n < other.size(); ++n) {
      if (random.Uniform() < 0.5) other[n] += RandomVector(&random, size);
    }
    EXPECT_GE(Objective(made.problem, sets[0], other, GetParam()),
              best * (1 - 1e-7));
  }
}

TEST_P(TripletPrograms, NoiseMovesTheCentresALittle) {
  RandomProblem made = MakeRandomProblem(15, Band(15, 4), 10);
  AddNoise(0.003, 11, &made.problem);
  EXPECT_LT(ErrorOfFirstPart(made, Solve(made.problem)), 0.05);
}

TEST(TripletProgramNorms, TheSumBearsAWrongTripletThatTheMaximumDoesNot) {
  RandomProblem made = MakeRandomProblem(10, Band(10, 4), 12);
  // Every triplet of edges 0, 1 and the third; a wrong, most meaningful ratio.
  made.problem.ratios[0].log_ratio += 0.5;
  made.problem.ratios[0].log10_nfa = -100;
  TripletProgramOptions options;
  options.max_closure_deg = 180;
  const auto sum = TripletProgramAverager(Norm::kSum, options)
                       .Solve(made.problem, RunContext());
  const auto maximum = TripletProgramAverager(Norm::kMaximum, options)
                           .Solve(made.problem, RunContext());
  ASSERT_TRUE(sum && maximum);
  EXPECT_LT(ErrorOfFirstPart(made, *sum), 1e-6);
  EXPECT_GT(ErrorOfFirstPart(made, *maximum), 1e-3);
}

TEST(TripletProgramNorms, TooManyTripletsAreRefusedByNumber) {
  const TranslationProblem problem =
      MakeRandomProblem(800, Band(800, 4), 1, /*with_ratios=*/false).problem;
  const auto refused =
      TripletProgramAverager(Norm::kSum).Solve(problem, RunContext());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(refused.error().message.find("at most 2000"), std::string::npos)
      << refused.error().message;
}

}  // namespace
}  // namespace lowlap
