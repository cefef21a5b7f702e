#include "lowlap/averaging/centers/internal/contradicted_ratio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "averaging/true_ratios.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/evaluation/pose_errors.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Twelve views with true ratios; that of 5-6-7 chance explains as well, and
// that of 8-9-10 is `factor` times too large.
SyntheticScene SceneWithAFalseRatio(const std::string& pairs, double factor,
                                    double log10_nfa) {
  SyntheticOptions options;
  options.num_views = 12;
  options.pairs = pairs;
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    if (ratio.views == ViewTriplet{5, 6, 7}) {
      ratio.verdict = RatioVerdict::kNotMeaningful;
    }
    if (ratio.views == ViewTriplet{8, 9, 10}) {
      ratio.log10_nfa = log10_nfa;
      ratio.log_ratio += std::log(factor);
    }
  }
  return synthetic;
}

TEST(ContradictedRatio, IsLeftOutWhereItOpensALoop) {
  for (const double factor : {0.01, 5.0, 100.0}) {
    SyntheticScene synthetic = SceneWithAFalseRatio("cycle", factor, -2);
    const auto summary =
        SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
    ASSERT_TRUE(summary) << summary.error().ToString();
    EXPECT_EQ(summary->num_placed, 12) << factor;
    EXPECT_THAT(summary->left_out_ratios, ElementsAre(ViewTriplet{8, 9, 10}))
        << factor;
    EXPECT_THAT(summary->kept_outliers, IsEmpty());
    EXPECT_LT(EvaluatePoses(synthetic.scene, synthetic.true_poses).position.max,
              1e-6)
        << factor;
  }
}

TEST(ContradictedRatio,
     StaysWhereItHasMoreEvidenceThanDirectionsHaveAgainstIt) {
  SyntheticScene synthetic = SceneWithAFalseRatio("cycle", 100, -50);
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_THAT(summary->left_out_ratios, IsEmpty());
  EXPECT_FALSE(summary->kept_outliers.empty());
}

TEST(ContradictedRatio, IsNotFoundInAChain) {
  SyntheticScene synthetic = SceneWithAFalseRatio("chain", 100, -2);
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_THAT(summary->left_out_ratios, IsEmpty());
}

TEST(ContradictedRatio, NoneIsLeftOutOfARightLoop) {
  SyntheticScene synthetic = SceneWithAFalseRatio("cycle", 1, -2);
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_THAT(summary->left_out_ratios, IsEmpty());
  EXPECT_LT(EvaluatePoses(synthetic.scene, synthetic.true_poses).position.max,
            1e-6);
}

// Places the last view only where there is a ratio.
class NeedsARatio : public TranslationAverager {
 public:
  std::string Name() const override { return "needs_a_ratio"; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext&) const override {
    TranslationSolution solution;
    solution.component.assign(problem.views.size(), 0);
    if (problem.ratios.empty()) solution.component.back() = -1;
    solution.center_in_world.assign(problem.views.size(), Vec3::Zero());
    solution.num_components = 1;
    return solution;
  }
};

TEST(ContradictedRatio, IsKeptIfAViewWouldBeLost) {
  TranslationProblem problem;
  problem.views = {0, 1, 2};
  problem.edges.resize(2);
  problem.edges[0] = {0, 1};
  problem.edges[1] = {1, 2};
  RatioMeasurement ratio;
  ratio.reference = 0;
  ratio.target = 1;
  problem.ratios = {ratio};
  const NeedsARatio averager;
  const auto solution = averager.Solve(problem, RunContext());
  const auto without = SolveWithoutContradictedRatio(
      problem, averager, *solution,
      [](const TranslationSolution&) { return true; }, RunContext());
  ASSERT_TRUE(without);
  EXPECT_FALSE(without->has_value());
}

// Fails where it is asked.
class MayNotBeAsked : public TranslationAverager {
 public:
  std::string Name() const override { return "may_not_be_asked"; }
  Result<TranslationSolution> Solve(const TranslationProblem&,
                                    const RunContext&) const override {
    return MakeError(ErrorCode::kNumerical, "asked");
  }
};

TEST(ContradictedRatio, IsNotSoughtAmongRatiosThatOthersOutvote) {
  TranslationProblem problem;
  problem.views = {0, 1, 2, 3};
  problem.edges.resize(3);
  TranslationSolution solution;
  solution.component.assign(4, 0);
  solution.center_in_world = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(),
                              Vec3::UnitZ()};
  solution.num_components = 1;
  for (std::size_t e = 0; e < 3; ++e) {
    problem.edges[e].first = 0;
    problem.edges[e].second = e + 1;
    problem.edges[e].direction_in_world = solution.center_in_world[e + 1];
    problem.edges[e].stddev_rad = 0.01;
  }
  const auto add_ratio = [&](std::size_t reference, std::size_t target) {
    RatioMeasurement ratio;
    ratio.reference = reference;
    ratio.target = target;
    ratio.log_ratio = 3;  // not that of the solution
    ratio.stddev = 0.01;
    problem.ratios.push_back(ratio);
  };
  const auto solve = [&] {
    return SolveWithoutContradictedRatio(
        problem, MayNotBeAsked(), solution,
        [](const TranslationSolution&) { return true; }, RunContext());
  };
  add_ratio(0, 1);
  add_ratio(1, 2);
  EXPECT_FALSE(solve()) << "each is the only one of its edges";
  add_ratio(0, 2);
  const auto without = solve();
  ASSERT_TRUE(without) << without.error().ToString();
  EXPECT_FALSE(without->has_value());
}

}  // namespace
}  // namespace lowlap
