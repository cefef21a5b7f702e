#include "lowlap/averaging/centers/internal/grown_centers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "averaging/random_problem.h"
#include "lowlap/averaging/internal/problem_errors.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

Edges AllPairs(std::size_t begin, std::size_t end) {
  Edges edges;
  for (std::size_t a = begin; a < end; ++a) {
    for (std::size_t b = a + 1; b < end; ++b) edges.emplace_back(a, b);
  }
  return edges;
}

EvidenceOfPairs EqualEvidence(const TranslationProblem& problem,
                              double evidence) {
  EvidenceOfPairs result;
  for (const DirectionEdge& edge : problem.edges) {
    result[ViewsOf(problem, edge)] = evidence;
  }
  return result;
}

std::vector<ViewPair> Contradictions(const TranslationProblem& problem,
                                     const EvidenceOfPairs& evidence,
                                     std::size_t max_starts = 10) {
  return ContradictionsOfGrowth(problem, evidence, {5.0, RadFromDeg(1.0)},
                                max_starts);
}

// Moves a view for one edge alone: its direction, and its ratios, of which
// those of two such edges to one view agree with each other.
void MoveFor(const std::vector<std::size_t>& edges, std::size_t view,
             const Vec3& center, RandomProblem* made) {
  TranslationProblem& problem = made->problem;
  std::vector<double> stretch(problem.edges.size(), 0);
  for (const std::size_t n : edges) {
    DirectionEdge& edge = problem.edges[n];
    std::vector<Vec3> centers = made->centers;
    const double length = (centers[edge.second] - centers[edge.first]).norm();
    centers[view] = center;
    const Vec3 baseline = centers[edge.second] - centers[edge.first];
    edge.direction_in_world = baseline.normalized();
    stretch[n] = std::log(baseline.norm() / length);
  }
  for (RatioMeasurement& ratio : problem.ratios) {
    ratio.log_ratio += stretch[ratio.target] - stretch[ratio.reference];
  }
}

TEST(ContradictionsOfGrowth, NothingContradictsAnExactProblem) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RandomProblem made = MakeRandomProblem(7, AllPairs(0, 7), seed);
    EXPECT_THAT(Contradictions(made.problem, EqualEvidence(made.problem, 30)),
                IsEmpty());
  }
}

TEST(ContradictionsOfGrowth, OfAnEmptyProblemThereAreNone) {
  EXPECT_THAT(Contradictions({}, {}), IsEmpty());
}

// View 6 is where three right relative poses say, or where three false ones
// that agree say, whichever have more evidence.
TEST(ContradictionsOfGrowth, TheSideWithMoreEvidencePlacesAView) {
  const Edges edges = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}, {0, 4},
                       {1, 4}, {2, 4}, {3, 4}, {0, 5}, {1, 5}, {2, 5}, {3, 5},
                       {0, 6}, {1, 6}, {2, 6}, {3, 6}, {4, 6}, {5, 6}};
  RandomProblem made = MakeRandomProblem(7, edges, 5);
  MoveFor({14, 15, 16}, 6, made.centers[6] + Vec3(6, -5, 4), &made);
  const auto id = [&](std::size_t view) { return made.problem.views[view]; };
  for (const double of_false : {20.0, 40.0}) {
    EvidenceOfPairs evidence = EqualEvidence(made.problem, 30);
    for (const std::size_t view : {0, 1, 2}) {
      evidence[{id(view), id(6)}] = of_false;
    }
    const std::size_t begin = of_false < 30 ? 0 : 3;
    EXPECT_THAT(
        Contradictions(made.problem, evidence),
        ElementsAre(ViewPair{id(begin), id(6)}, ViewPair{id(begin + 1), id(6)},
                    ViewPair{id(begin + 2), id(6)}))
        << of_false;
  }
}

// The strongest ratio is that of two false relative poses, which outvote one
// right one at a time, and not all of them.
TEST(ContradictionsOfGrowth, OfSeveralStartsTheOneCountsThatMostAgreesWith) {
  RandomProblem made = MakeRandomProblem(7, AllPairs(0, 7), 5);
  TranslationProblem& problem = made.problem;
  const auto is_false = [&](std::size_t n) {
    return problem.edges[n].first < 2 && problem.edges[n].second == 6;
  };
  EvidenceOfPairs evidence = EqualEvidence(problem, 30);
  std::vector<std::size_t> false_edges;
  for (std::size_t n = 0; n < problem.edges.size(); ++n) {
    if (!is_false(n)) continue;
    false_edges.push_back(n);
    evidence[ViewsOf(problem, problem.edges[n])] = 40;
  }
  MoveFor(false_edges, 6, made.centers[6] + Vec3(6, -5, 4), &made);
  for (RatioMeasurement& ratio : problem.ratios) {
    if (is_false(ratio.reference) && is_false(ratio.target)) {
      ratio.log10_nfa = -60;
    }
  }
  const auto id = [&](std::size_t view) { return problem.views[view]; };
  EXPECT_THAT(Contradictions(problem, evidence, 1),
              ElementsAre(ViewPair{id(2), id(6)}, ViewPair{id(3), id(6)},
                          ViewPair{id(4), id(6)}, ViewPair{id(5), id(6)}));
  EXPECT_THAT(Contradictions(problem, evidence, 10),
              ElementsAre(ViewPair{id(0), id(6)}, ViewPair{id(1), id(6)}));
  EXPECT_THAT(Contradictions(problem, evidence, 0), IsEmpty());
}

// As of two places that look alike, one behind the other.
TEST(ContradictionsOfGrowth, ARightDirectionWithFalseRatiosContradicts) {
  RandomProblem made = MakeRandomProblem(6, AllPairs(0, 6), 7);
  const DirectionEdge edge = made.problem.edges.back();  // 4, 5
  const std::size_t last = made.problem.edges.size() - 1;
  MoveFor({last}, 5, made.centers[4] + 2 * (made.centers[5] - made.centers[4]),
          &made);
  EvidenceOfPairs evidence = EqualEvidence(made.problem, 30);
  evidence[ViewsOf(made.problem, edge)] = 10;
  EXPECT_THAT(Contradictions(made.problem, evidence),
              ElementsAre(ViewsOf(made.problem, edge)));
}

// Two parts that a ratio does not join have no scale in common.
TEST(ContradictionsOfGrowth, WhatJoinsPartsIsNotJudged) {
  Edges edges = AllPairs(0, 4);
  const Edges others = AllPairs(4, 8);
  edges.insert(edges.end(), others.begin(), others.end());
  RandomProblem made = MakeRandomProblem(8, edges, 9);
  for (const auto& [first, second] : Edges{{0, 4}, {1, 5}, {2, 6}}) {
    DirectionEdge edge;
    edge.first = first;
    edge.second = second;
    edge.direction_in_world = Vec3::UnitZ();
    made.problem.edges.push_back(edge);
  }
  EXPECT_THAT(Contradictions(made.problem, EqualEvidence(made.problem, 30)),
              IsEmpty());
}

}  // namespace
}  // namespace lowlap
