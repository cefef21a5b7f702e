#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "averaging/random_problem.h"
#include "lowlap/averaging/averager_registry.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

// Views on a circle of slightly varied height and radius, each joined with the
// next `reach` ones.
RandomProblem MakeRing(std::size_t num_views, std::size_t reach,
                       std::uint64_t seed) {
  Edges edges;
  for (std::size_t n = 0; n < num_views; ++n) {
    for (std::size_t step = 1; step <= reach; ++step) {
      edges.push_back({n, (n + step) % num_views});
    }
  }
  RandomProblem made =
      MakeRandomProblem(num_views, edges, seed, /*with_ratios=*/false);
  Random random(seed);
  for (std::size_t n = 0; n < num_views; ++n) {
    const double angle =
        2 * M_PI * static_cast<double>(n) / static_cast<double>(num_views);
    const double radius = random.Uniform(4, 6);
    made.centers[n] = {radius * std::cos(angle), radius * std::sin(angle),
                       random.Uniform(-0.5, 0.5)};
  }
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (made.centers[edge.second] - made.centers[edge.first]).normalized();
    edge.stddev_rad = 0.005;
  }
  return made;
}

void AddNoise(double stddev_rad, std::uint64_t seed, RandomProblem* made) {
  Random random(seed);
  for (DirectionEdge& edge : made->problem.edges) {
    edge.direction_in_world =
        (edge.direction_in_world + GaussianVector(&random, stddev_rad))
            .normalized();
  }
}

// Every `period`-th edge points anywhere.
void AddWrongDirections(std::size_t period, std::uint64_t seed,
                        RandomProblem* made) {
  Random random(seed);
  std::size_t n = 0;
  for (DirectionEdge& edge : made->problem.edges) {
    if (n++ % period != period - 1) continue;
    edge.direction_in_world = GaussianVector(&random, 1).normalized();
  }
}

std::vector<bool> AllPlaced(const TranslationSolution& solution) {
  std::vector<bool> placed;
  for (const int component : solution.component) {
    placed.push_back(component == 0);
  }
  return placed;
}

TranslationSolution Solve(const std::string& name,
                          const TranslationProblem& problem) {
  const auto averager = AveragerRegistry::WithBuiltIns().Make(name);
  EXPECT_TRUE(averager);
  EXPECT_EQ((*averager)->Name(), name);
  auto solution = (*averager)->Solve(problem, RunContext());
  EXPECT_TRUE(solution);
  return solution ? *solution : TranslationSolution();
}

double Error(const RandomProblem& made, const TranslationSolution& solution) {
  EXPECT_EQ(solution.num_components, 1);
  return GaugeFreeError(made.centers, solution.center_in_world,
                        AllPlaced(solution));
}

class DirectionStrategy : public ::testing::TestWithParam<std::string> {
 protected:
  TranslationSolution Solve(const TranslationProblem& problem) {
    return lowlap::Solve(GetParam(), problem);
  }
};

TEST_P(DirectionStrategy, ExactWithoutNoise) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const RandomProblem made = MakeRing(20, 3, seed);
    const TranslationSolution solution = Solve(made.problem);
    EXPECT_EQ(
        std::count(solution.component.begin(), solution.component.end(), 0),
        20);
    EXPECT_GT(solution.num_iterations, 0);
    EXPECT_LT(Error(made, solution), 1e-6) << seed;
  }
}

TEST_P(DirectionStrategy, ExactOnASpatialQuadrilateral) {
  RandomProblem made =
      MakeRandomProblem(4, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, 1,
                        /*with_ratios=*/false);
  made.centers = {{0, 0, 0}, {2, 0, 1}, {2, 2, 0}, {0, 2, 1.5}};
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (made.centers[edge.second] - made.centers[edge.first]).normalized();
  }
  EXPECT_LT(Error(made, Solve(made.problem)), 1e-6);
}

TEST_P(DirectionStrategy, KeepsTheSideThatDirectionsPointTo) {
  const RandomProblem made = MakeRing(12, 3, 4);
  const TranslationSolution solution = Solve(made.problem);
  for (const DirectionEdge& edge : made.problem.edges) {
    const Vec3 offset = solution.center_in_world[edge.second] -
                        solution.center_in_world[edge.first];
    EXPECT_GT(edge.direction_in_world.dot(offset), 0);
  }
}

TEST_P(DirectionStrategy, SmallNoiseGivesSmallErrors) {
  RandomProblem made = MakeRing(20, 4, 5);
  AddNoise(0.002, 6, &made);
  EXPECT_LT(Error(made, Solve(made.problem)), 0.03);
}

TEST_P(DirectionStrategy, DoesNotDependOnTheGauge) {
  RandomProblem made = MakeRing(15, 3, 7);
  AddNoise(0.005, 8, &made);
  const TranslationSolution solution = Solve(made.problem);
  const Mat3 turn = RotationFromAngleAxis(Vec3(0.3, -0.8, 0.5));
  TranslationProblem turned = made.problem;
  for (DirectionEdge& edge : turned.edges) {
    edge.direction_in_world = turn * edge.direction_in_world;
  }
  TranslationSolution back = Solve(turned);
  for (Vec3& center : back.center_in_world) center = turn.transpose() * center;
  EXPECT_LT(GaugeFreeError(solution.center_in_world, back.center_in_world,
                           AllPlaced(back)),
            1e-4);
}

TEST_P(DirectionStrategy, DoesNotDependOnTheOrderOfEdgesNorTheirSides) {
  RandomProblem made = MakeRing(15, 3, 9);
  AddNoise(0.005, 10, &made);
  const TranslationSolution solution = Solve(made.problem);
  TranslationProblem other = made.problem;
  std::reverse(other.edges.begin(), other.edges.end());
  for (std::size_t e = 0; e < other.edges.size(); e += 3) {
    DirectionEdge& edge = other.edges[e];
    std::swap(edge.first, edge.second);
    edge.direction_in_world = -edge.direction_in_world;
  }
  const TranslationSolution again = Solve(other);
  EXPECT_EQ(again.component, solution.component);
  EXPECT_LT(GaugeFreeError(solution.center_in_world, again.center_in_world,
                           AllPlaced(again)),
            1e-4);
}

TEST_P(DirectionStrategy, SameInputSameBytes) {
  RandomProblem made = MakeRing(15, 3, 11);
  AddNoise(0.01, 12, &made);
  const TranslationSolution a = Solve(made.problem);
  const TranslationSolution b = Solve(made.problem);
  for (std::size_t n = 0; n < a.center_in_world.size(); ++n) {
    EXPECT_EQ(a.center_in_world[n], b.center_in_world[n]);
  }
}

TEST_P(DirectionStrategy, PlacesNothingOnAChain) {
  Edges edges;
  for (std::size_t n = 0; n < 20; ++n) edges.push_back({n, n + 1});
  // Ratios would fix the scales; these strategies do not see them.
  const RandomProblem made = MakeRandomProblem(21, edges, 13);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 0);
  EXPECT_EQ(solution.component, std::vector<int>(21, -1));
}

TEST_P(DirectionStrategy, PlacesNothingOnALine) {
  RandomProblem made = MakeRing(8, 3, 14);
  for (std::size_t n = 0; n < 8; ++n) {
    made.centers[n] = Vec3(static_cast<double>(n), 0, 0);
  }
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (made.centers[edge.second] - made.centers[edge.first]).normalized();
  }
  AddNoise(0.005, 15, &made);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 0);
}

TEST_P(DirectionStrategy, PlacesALineThatAViewBesideItHolds) {
  Edges edges;
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 7; ++b) edges.push_back({a, b});
  }
  RandomProblem made = MakeRandomProblem(7, edges, 16, /*with_ratios=*/false);
  for (std::size_t n = 0; n < 6; ++n) {
    made.centers[n] = Vec3(static_cast<double>(n), 0, 0);
  }
  made.centers[6] = Vec3(2.5, 3, 0);
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (made.centers[edge.second] - made.centers[edge.first]).normalized();
  }
  EXPECT_LT(Error(made, Solve(made.problem)), 1e-6);
}

TEST_P(DirectionStrategy, PartsThatShareNoScaleAreComponents) {
  // Two rings of 8 views that meet in view 0 only, and a view on a thread.
  RandomProblem made = MakeRing(8, 3, 17);
  const RandomProblem other = MakeRing(8, 3, 18);
  for (std::size_t n = 1; n < 8; ++n) {
    made.problem.views.push_back(static_cast<ViewId>(1000 + n));
    made.problem.cam_from_world.push_back(Mat3::Identity());
    made.centers.push_back(other.centers[n]);
  }
  for (DirectionEdge edge : other.problem.edges) {
    if (edge.first != 0) edge.first += 7;
    if (edge.second != 0) edge.second += 7;
    made.problem.edges.push_back(edge);
  }
  made.problem.views.push_back(5000);
  made.problem.cam_from_world.push_back(Mat3::Identity());
  made.centers.push_back(Vec3(9, 9, 9));
  DirectionEdge thread;
  thread.first = 3;
  thread.second = 15;
  made.problem.edges.push_back(thread);

  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 2);
  std::map<int, int> sizes;
  for (const int component : solution.component) ++sizes[component];
  EXPECT_EQ(sizes, (std::map<int, int>{{-1, 1}, {0, 8}, {1, 7}}));
  EXPECT_EQ(solution.component[15], -1);
  for (int component = 0; component < 2; ++component) {
    std::vector<bool> placed;
    for (const int each : solution.component) {
      placed.push_back(each == component);
    }
    std::vector<Vec3> truth = made.centers;
    EXPECT_LT(GaugeFreeError(truth, solution.center_in_world, placed), 1e-6);
  }
}

TEST_P(DirectionStrategy, SurvivesEveryDirectionBeingWrong) {
  RandomProblem made = MakeRing(15, 4, 19);
  AddWrongDirections(1, 20, &made);
  const TranslationSolution solution = Solve(made.problem);
  for (const Vec3& center : solution.center_in_world) {
    EXPECT_TRUE(center.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(All, DirectionStrategy,
                         ::testing::Values("l2_chordal", "soft_l1", "lud",
                                           "revised_lud", "bata",
                                           "revised_bata"));

class RobustStrategy : public ::testing::TestWithParam<std::string> {};

TEST_P(RobustStrategy, WithstandsWrongDirectionsThatBendLeastSquares) {
  for (const std::size_t period : {10, 5}) {
    RandomProblem made = MakeRing(30, 8, 21);
    AddNoise(0.002, 22, &made);
    AddWrongDirections(period, 23, &made);
    const double robust = Error(made, Solve(GetParam(), made.problem));
    const double squares = Error(made, Solve("l2_chordal", made.problem));
    EXPECT_LT(robust, 0.05) << period;
    EXPECT_GT(squares, 0.2) << period;
    RecordProperty("wrong_1_in_" + std::to_string(period),
                   std::to_string(robust) + " vs " + std::to_string(squares));
  }
}

INSTANTIATE_TEST_SUITE_P(All, RobustStrategy,
                         ::testing::Values("soft_l1", "lud", "revised_lud",
                                           "bata", "revised_bata"));

TEST(Lud, IsExactInSpiteOfSomeWrongDirections) {
  RandomProblem made = MakeRing(20, 6, 24);
  AddWrongDirections(10, 25, &made);
  EXPECT_LT(Error(made, Solve("lud", made.problem)), 1e-4);
  EXPECT_LT(Error(made, Solve("revised_lud", made.problem)), 1e-4);
}

TEST(Bata, IsLessSensitiveToShortBaselinesThanLud) {
  // Ten close pairs: their baselines are a hundredth of the others', their
  // directions poor.
  double lud = 0, bata = 0;
  for (std::uint64_t seed = 26; seed < 31; ++seed) {
    RandomProblem made = MakeRing(20, 5, seed);
    Random random(seed);
    for (std::size_t n = 0; n < 20; n += 2) {
      made.centers[n + 1] = made.centers[n] + RandomVector(&random, 0.05);
    }
    for (DirectionEdge& edge : made.problem.edges) {
      const Vec3 offset = made.centers[edge.second] - made.centers[edge.first];
      edge.direction_in_world = offset.normalized();
      if (offset.norm() < 0.2) edge.stddev_rad = 0.3;
    }
    AddNoise(0.005, seed, &made);
    lud += Error(made, Solve("lud", made.problem));
    bata += Error(made, Solve("bata", made.problem));
  }
  EXPECT_LT(bata, lud);
}

}  // namespace
}  // namespace lowlap
