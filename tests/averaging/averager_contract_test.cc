// What every built-in strategy keeps of what TranslationAverager promises.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "averaging/big_graph.h"
#include "lowlap/averaging/averager_registry.h"

namespace lowlap {
namespace {

// 30 views in a town, with ratios and with tracks that see all they need to.
TranslationProblem SmallTown() {
  BigGraphOptions options;
  options.num_views = 30;
  options.num_edges = 120;
  options.num_ratios = 300;
  BigGraph graph = MakeBigGraph(options);
  TranslationProblem problem = graph.made.problem;
  Random random(5);
  for (int k = 0; k < 300; ++k) {
    const Vec3 point = RandomVector(&random, 20);
    TrackRays track;
    for (std::size_t view = 0; view < options.num_views; ++view) {
      if (random.Uniform() > 0.3) continue;
      track.observations.push_back(
          {view, (point - graph.made.centers[view]).normalized()});
    }
    problem.tracks.push_back(std::move(track));
  }
  return problem;
}

std::vector<std::string> Requests() {
  std::vector<std::string> names = AveragerRegistry::WithBuiltIns().Names();
  names.push_back("1dsfm+lud");
  return names;
}

class AveragerContract : public ::testing::TestWithParam<std::string> {
 protected:
  AveragerRegistry::Averager averager_ =
      *AveragerRegistry::WithBuiltIns().Make(GetParam());
};

TEST_P(AveragerContract, RefusesInvalidProblems) {
  RandomProblem made = MakeRandomProblem(
      3, std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {1, 2}}, 4);
  made.problem.ratios[0].target = 7;
  const auto solution = averager_->Solve(made.problem, RunContext());
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().code, ErrorCode::kInvalidArgument);
}

// Whenever the host says stop, it is not asked again, and the answer is
// kCancelled. It is asked before every iteration, however many there are, so
// that the time until the answer is one iteration's.
TEST_P(AveragerContract, StopsWhenItIsAskedTo) {
  const TranslationProblem problem = SmallTown();
  RunContext context;
  context.num_threads = 1;
  int num_questions = 0, stop_at = 0;
  std::size_t most_done = 0,
              stop_when_done = std::numeric_limits<std::size_t>::max();
  bool is_stopped = false;
  context.progress = [&](const std::string&, std::size_t done,
                         std::size_t total) {
    EXPECT_LE(done, total);
    EXPECT_FALSE(is_stopped);
    most_done = std::max(most_done, done);
    is_stopped = ++num_questions == stop_at || done >= stop_when_done;
    return !is_stopped;
  };
  const auto whole = averager_->Solve(problem, context);
  ASSERT_TRUE(whole) << whole.error().message;
  ASSERT_GT(num_questions, 0);
  const bool by_simplex =
      averager_->Name() == "linf" || averager_->Name() == "l1_lp";
  EXPECT_GE(num_questions,
            by_simplex ? whole->num_iterations / 32 : whole->num_iterations);
  const int all = num_questions;
  const auto expect_cancelled = [&] {
    num_questions = 0;
    is_stopped = false;
    const auto stopped = averager_->Solve(problem, context);
    ASSERT_FALSE(stopped) << num_questions << " of " << all;
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
    EXPECT_TRUE(is_stopped);
  };
  for (const int stop : {1, (all + 1) / 2}) {
    stop_at = stop;
    expect_cancelled();
    EXPECT_EQ(num_questions, stop);
  }
  // The simplex asks at every 16th step, and by the clock: which question is
  // the last is told by the steps, not by their number.
  stop_at = by_simplex ? 0 : all;
  if (by_simplex) stop_when_done = most_done / 16 * 16;
  expect_cancelled();
}

TEST_P(AveragerContract, AnswersTheSameWithoutSinks) {
  const TranslationProblem problem = SmallTown();
  RunContext with_sinks;
  with_sinks.log = [](LogLevel, const std::string&) {};
  with_sinks.progress = [](const std::string&, std::size_t, std::size_t) {
    return true;
  };
  const auto a = averager_->Solve(problem, with_sinks);
  const auto b = averager_->Solve(problem, RunContext());
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->component, b->component);
  EXPECT_EQ(a->center_in_world, b->center_in_world);
}

INSTANTIATE_TEST_SUITE_P(All, AveragerContract,
                         ::testing::ValuesIn(Requests()));

}  // namespace
}  // namespace lowlap
