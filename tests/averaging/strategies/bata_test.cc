#include "lowlap/averaging/strategies/internal/bata.h"

#include <gtest/gtest.h>

#include <cmath>

#include "averaging/strategies/small_directions.h"
#include "lowlap/averaging/strategies/internal/revised_bata.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"

namespace lowlap {
namespace {

std::vector<Vec3> SolveBata(const DirectionPart& part,
                            const BataOptions& options = {}) {
  int iterations = 0;
  const auto centers = SolveBata(part, options, RunContext(), &iterations);
  EXPECT_TRUE(centers);
  return *centers;
}

// Huber's loss of a sine, from the definition.
double LossOf(double sine) {
  return sine <= 0.1 ? sine * sine / 2 : 0.1 * (sine - 0.05);
}

TEST(AngleObjective, IsHubersLossOfTheSineWhateverTheLength) {
  DirectionPart part = MakeTriangle().part;
  part.edges.resize(1);  // along x
  for (const double length : {1e-3, 1.0, 1e3}) {
    const auto cost = [&](double angle) {
      const Vec3 end(length * std::cos(angle), 0, length * std::sin(angle));
      return AngleObjective(part, {Vec3::Zero(), end, Vec3::Zero()});
    };
    EXPECT_EQ(cost(0), 0);
    for (const double angle : {0.01, 0.1, 0.2, 1.5}) {
      EXPECT_NEAR(cost(angle), LossOf(std::sin(angle)), 1e-14) << angle;
    }
    // Beyond a right angle it is flat.
    for (const double angle : {1.6, 2.5, kPi}) {
      EXPECT_DOUBLE_EQ(cost(angle), LossOf(1)) << angle;
    }
  }
  EXPECT_DOUBLE_EQ(AngleObjective(part, std::vector<Vec3>(3, Vec3::Ones())),
                   LossOf(1));
}

class Bata : public ::testing::TestWithParam<int> {
 protected:
  SmallDirections small_ =
      MakeNoisyDirections(static_cast<std::uint64_t>(GetParam()));
};

TEST_P(Bata, DescendsWithEveryRound) {
  int iterations = 0;
  const auto start =
      SolveRevisedLud(small_.part, {}, RunContext(), &iterations);
  ASSERT_TRUE(start);
  double last = AngleObjective(small_.part, *start);
  for (const int rounds : {1, 2, 5, 10}) {
    const double cost =
        AngleObjective(small_.part, SolveBata(small_.part, {rounds}));
    EXPECT_LE(cost, last * (1 + 1e-12)) << rounds;
    last = cost;
  }
}

TEST_P(Bata, GoesTowardsTheMinimum) {
  int iterations = 0;
  const auto jointly =
      SolveRevisedBata(small_.part, {}, RunContext(), &iterations);
  ASSERT_TRUE(jointly);
  const double least = AngleObjective(small_.part, *jointly);
  // A hundred steps of block descent do not quite reach the minimum.
  const double by_blocks = AngleObjective(small_.part, SolveBata(small_.part));
  EXPECT_GE(by_blocks, least * (1 - 1e-6));
  EXPECT_LE(by_blocks, least * 1.02);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Bata, ::testing::Range(1, 5));

TEST(SolveBata, LeavesExactDirectionsExact) {
  const SmallDirections small = PartOf(MakeTenViews(7));
  EXPECT_LT(GaugeFreeError(small.made.centers, SolveBata(small.part),
                           std::vector<bool>(10, true)),
            1e-8);
}

TEST(SolveBata, CountsTheIterationsOfItsStartAndItsOwn) {
  const SmallDirections small = MakeNoisyDirections(5);
  int of_start = 0;
  ASSERT_TRUE(SolveRevisedLud(small.part, {}, RunContext(), &of_start));
  int iterations = 1000;
  ASSERT_TRUE(SolveBata(small.part, {3, 4}, RunContext(), &iterations));
  EXPECT_EQ(iterations, 1000 + of_start + 12);
}

TEST(SolveBata, StopsInItsStartAndInItsOwnSteps) {
  const SmallDirections small = MakeNoisyDirections(5);
  int of_start = 0;
  ASSERT_TRUE(SolveRevisedLud(small.part, {}, RunContext(), &of_start));
  for (const int question : {1, of_start, of_start + 1, of_start + 100}) {
    int iterations = 0;
    const auto stopped =
        SolveBata(small.part, {}, StopAt(question), &iterations);
    ASSERT_FALSE(stopped) << question;
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(iterations, question - 1);
  }
}

TEST(BataOptions, NeedRoundsAndSteps) {
  EXPECT_TRUE(BataOptions().Validate());
  EXPECT_FALSE((BataOptions{0, 1}.Validate()));
  ASSERT_FALSE((BataOptions{1, 0}.Validate()));
  EXPECT_EQ((BataOptions{1, 0}.Validate().error().code),
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace lowlap
