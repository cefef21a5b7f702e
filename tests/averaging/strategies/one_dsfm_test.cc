#include "lowlap/averaging/strategies/internal/one_dsfm.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "averaging/random_problem.h"
#include "lowlap/averaging/averager_registry.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

struct SpoiledProblem {
  RandomProblem made;
  std::vector<bool> is_wrong;
};

// Every view with the next ten; a share of the directions is random.
SpoiledProblem Spoil(double share, std::uint64_t seed,
                     std::size_t num_views = 60) {
  Edges edges;
  for (std::size_t n = 0; n < num_views; ++n) {
    for (std::size_t step = 1; step <= 10; ++step) {
      edges.push_back({n, (n + step) % num_views});
    }
  }
  SpoiledProblem spoiled{MakeRandomProblem(num_views, edges, seed, false), {}};
  Random random(seed + 1);
  for (DirectionEdge& edge : spoiled.made.problem.edges) {
    const bool is_wrong = random.Uniform() < share;
    spoiled.is_wrong.push_back(is_wrong);
    if (is_wrong) {
      Vec3 other = RandomVector(&random, 1);
      while (other.norm() > 1) other = RandomVector(&random, 1);
      edge.direction_in_world = other.normalized();
    } else {
      edge.direction_in_world =
          (edge.direction_in_world + RandomVector(&random, 0.01)).normalized();
    }
  }
  return spoiled;
}

class WrongShare : public ::testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(OneDSfm, WrongShare, ::testing::Values(0.2, 0.3));

TEST_P(WrongShare, MostWrongEdgesAreFound) {
  const OneDSfmOptions options;
  double wrong = 0, wrong_left = 0, right = 0, right_lost = 0, opposed = 0,
         opposed_left = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const SpoiledProblem spoiled = Spoil(GetParam(), 10 * seed);
    const auto z =
        EdgeContradictions(spoiled.made.problem, options, RunContext());
    ASSERT_TRUE(z);
    for (std::size_t e = 0; e < z->size(); ++e) {
      const bool is_kept = (*z)[e] <= options.max_contradiction;
      if (!spoiled.is_wrong[e]) {
        right += 1;
        right_lost += is_kept ? 0 : 1;
        continue;
      }
      wrong += 1;
      wrong_left += is_kept ? 1 : 0;
      // Beyond a right angle: what an ordering can tell best.
      const DirectionEdge& edge = spoiled.made.problem.edges[e];
      const Vec3 truth =
          spoiled.made.centers[edge.second] - spoiled.made.centers[edge.first];
      if (truth.dot(edge.direction_in_world) < 0) {
        opposed += 1;
        opposed_left += is_kept ? 1 : 0;
      }
    }
  }
  EXPECT_LT(wrong_left / wrong, 0.45);
  EXPECT_LT(opposed_left / opposed, 0.1);
  EXPECT_LT(right_lost / right, 0.1);
  RecordProperty("wrong_left_percent",
                 static_cast<int>(100 * wrong_left / wrong));
  RecordProperty("right_lost_percent",
                 static_cast<int>(100 * right_lost / right));
}

TEST(OneDSfm, NothingContradictsARightProblem) {
  const SpoiledProblem spoiled = Spoil(0, 5);
  RandomProblem exact = spoiled.made;
  for (DirectionEdge& edge : exact.problem.edges) {
    edge.direction_in_world =
        (exact.centers[edge.second] - exact.centers[edge.first]).normalized();
  }
  const auto z = EdgeContradictions(exact.problem, {}, RunContext());
  ASSERT_TRUE(z);
  EXPECT_EQ(*std::max_element(z->begin(), z->end()), 0);
}

TEST(OneDSfm, DependsOnTheSeedAndNotOnTheThreads) {
  const SpoiledProblem spoiled = Spoil(0.3, 6);
  RunContext one, four, other;
  one.num_threads = 1;
  four.num_threads = 4;
  other.seed = 1;
  const auto a = EdgeContradictions(spoiled.made.problem, {}, one);
  const auto b = EdgeContradictions(spoiled.made.problem, {}, four);
  const auto c = EdgeContradictions(spoiled.made.problem, {}, other);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(*a, *b);
  EXPECT_NE(*a, *c);
}

TEST(OneDSfm, WithoutEdgesKeepsTheRatiosOfTheRest) {
  RandomProblem made =
      MakeRandomProblem(5, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}}, 7);
  const TranslationProblem kept =
      WithoutEdges(made.problem, {false, true, false, false});
  ASSERT_EQ(kept.edges.size(), 3u);
  EXPECT_EQ(kept.edges[1].first, 2u);
  ASSERT_EQ(kept.ratios.size(), 1u);
  EXPECT_EQ(kept.ratios[0].reference, 1u);
  EXPECT_EQ(kept.ratios[0].target, 2u);
  EXPECT_NEAR(kept.ratios[0].log_ratio, made.TrueLogRatio(2, 3), 1e-12);
  EXPECT_EQ(kept.views, made.problem.views);
}

TEST(OneDSfm, GoesInFrontOfAnyStrategy) {
  const RandomProblem made = MakeRandomProblem(
      5, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 2}, {1, 3}, {2, 4}}, 8);
  for (const std::string& name : AveragerRegistry::WithBuiltIns().Names()) {
    const auto plain = AveragerRegistry::WithBuiltIns().Make(name);
    const auto filtered =
        AveragerRegistry::WithBuiltIns().Make("1dsfm+" + name);
    ASSERT_TRUE(plain && filtered);
    EXPECT_EQ((*filtered)->Name(), "1dsfm+" + name);
    EXPECT_EQ((*filtered)->NeedsTracks(), (*plain)->NeedsTracks());
    const auto a = (*plain)->Solve(made.problem, RunContext());
    const auto b = (*filtered)->Solve(made.problem, RunContext());
    ASSERT_TRUE(a && b) << name;
    EXPECT_EQ(a->center_in_world, b->center_in_world) << name;
  }
  EXPECT_FALSE(AveragerRegistry::WithBuiltIns().Make("1dsfm+magic"));
  EXPECT_FALSE(AveragerRegistry::WithBuiltIns().Make("1dsfm+"));
}

TEST(OneDSfm, MakesTheTripletProgramsBearWrongEdges) {
  const SpoiledProblem spoiled = Spoil(0.1, 9, 30);
  const auto error = [&](const std::string& name) {
    const auto averager = AveragerRegistry::WithBuiltIns().Make(name);
    const auto solution =
        (*averager)->Solve(spoiled.made.problem, RunContext());
    std::vector<bool> placed;
    for (const int component : solution->component) {
      placed.push_back(component == 0);
    }
    EXPECT_GT(std::count(placed.begin(), placed.end(), true), 25);
    return GaugeFreeError(spoiled.made.centers, solution->center_in_world,
                          placed);
  };
  EXPECT_LT(error("1dsfm+l1_lp"), 0.1);
}

TEST(OneDSfm, RefusesWrongOptions) {
  const RandomProblem made = MakeRandomProblem(3, Edges{{0, 1}, {1, 2}}, 1);
  OneDSfmOptions options;
  options.num_projections = 0;
  const auto z = EdgeContradictions(made.problem, options, RunContext());
  ASSERT_FALSE(z);
  EXPECT_EQ(z.error().code, ErrorCode::kInvalidArgument);
}

TEST(OneDSfm, AProblemWithoutEdgesIsFine) {
  const RandomProblem made = MakeRandomProblem(3, {}, 1);
  const auto z = EdgeContradictions(made.problem, {}, RunContext());
  ASSERT_TRUE(z);
  EXPECT_TRUE(z->empty());
}

// A tree that hangs on a graph whose directions are all wrong.
TEST(OneDSfm, NeverContradictsAnEdgeOnNoCycle) {
  const Edges edges = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 4}, {0, 2},
                       {1, 3}, {4, 5}, {5, 6}, {5, 7}, {5, 8}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomProblem made = MakeRandomProblem(9, edges, seed, false);
    Random random(seed);
    for (std::size_t e = 0; e < 7; ++e) {
      made.problem.edges[e].direction_in_world =
          RandomVector(&random, 1).normalized();
    }
    const auto z = EdgeContradictions(made.problem, {}, RunContext());
    ASSERT_TRUE(z);
    for (std::size_t e = 7; e < edges.size(); ++e) {
      EXPECT_EQ((*z)[e], 0) << "seed " << seed << ", edge " << e;
    }
  }
}

}  // namespace
}  // namespace lowlap
