#include "lowlap/averaging/rotations/internal/rotation_averaging.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "averaging/random_problem.h"
#include "averaging/rotations/random_rotation_graph.h"
#include "lowlap/averaging/rotations/internal/rotation_cost.h"

namespace lowlap {
namespace {

std::vector<Mat3> RandomRotations(std::size_t count, Random* random) {
  std::vector<Mat3> rotations;
  for (std::size_t n = 0; n < count; ++n) {
    rotations.push_back(RandomRotation(random));
  }
  return rotations;
}

RotationMeasurement Measure(const std::vector<Mat3>& truth, std::size_t first,
                            std::size_t second, const Vec3& error) {
  RotationMeasurement m;
  m.first = first;
  m.second = second;
  m.second_from_first =
      RotationFromAngleAxis(error) * truth[second] * truth[first].transpose();
  return m;
}

double WorstError(const std::vector<Mat3>& truth,
                  const std::vector<Mat3>& solved) {
  double worst = 0;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    const Mat3 expected = truth[n] * truth[0].transpose() * solved[0];
    worst = std::max(worst, RotationAngleBetween(expected, solved[n]));
  }
  return worst;
}

TEST(AverageRotations, ChainIsComposedExactly) {
  Random random(1);
  const auto truth = RandomRotations(12, &random);
  std::vector<RotationMeasurement> measurements;
  for (std::size_t n = 0; n + 1 < truth.size(); ++n) {
    // Some measured against the direction of the chain.
    measurements.push_back(n % 3 == 0 ? Measure(truth, n + 1, n, Vec3::Zero())
                                      : Measure(truth, n, n + 1, Vec3::Zero()));
  }
  const auto result = AverageRotations(truth.size(), measurements);
  ASSERT_TRUE(result);
  EXPECT_LT(WorstError(truth, result->cam_from_world), 1e-12);
}

TEST(AverageRotations, LoopSpreadsItsClosingError) {
  Random random(2);
  const auto truth = RandomRotations(10, &random);
  std::vector<RotationMeasurement> measurements;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    measurements.push_back(
        Measure(truth, n, (n + 1) % truth.size(), Vec3(0.01, 0, 0)));
  }
  const auto result = AverageRotations(truth.size(), measurements);
  ASSERT_TRUE(result);
  const auto [least, most] = std::minmax_element(result->residuals_rad.begin(),
                                                 result->residuals_rad.end());
  EXPECT_LT(*most, 2.0 * *least + 1e-9);
}

TEST(AverageRotations, ForgetsAFifthOfWrongMeasurements) {
  Random random(3);
  const auto truth = RandomRotations(40, &random);
  std::vector<RotationMeasurement> measurements;
  std::vector<bool> wrong;
  for (std::size_t a = 0; a < truth.size(); ++a) {
    for (std::size_t step = 1; step <= 5; ++step) {
      const std::size_t b = (a + step) % truth.size();
      wrong.push_back(random.Uniform() < 0.2);
      const Vec3 noise = RandomVector(&random, 0.002);
      measurements.push_back(Measure(
          truth, a, b, wrong.back() ? RandomVector(&random, 1.5) : noise));
    }
  }
  const auto result = AverageRotations(truth.size(), measurements);
  ASSERT_TRUE(result);
  EXPECT_LT(WorstError(truth, result->cam_from_world), 0.004);
  for (std::size_t e = 0; e < wrong.size(); ++e) {
    if (!wrong[e]) {
      EXPECT_LT(result->residuals_rad[e], 0.01);
    }
  }
}

TEST(AverageRotations, DoesNotDependOnTheOrderOfMeasurements) {
  Random random(4);
  const auto truth = RandomRotations(8, &random);
  std::vector<RotationMeasurement> measurements;
  for (std::size_t a = 0; a < truth.size(); ++a) {
    for (std::size_t b = a + 1; b < truth.size(); ++b) {
      measurements.push_back(Measure(truth, a, b, RandomVector(&random, 0.01)));
    }
  }
  const auto forward = AverageRotations(truth.size(), measurements);
  std::reverse(measurements.begin(), measurements.end());
  const auto backward = AverageRotations(truth.size(), measurements);
  ASSERT_TRUE(forward && backward);
  for (std::size_t n = 0; n < truth.size(); ++n) {
    EXPECT_LT(RotationAngleBetween(forward->cam_from_world[n],
                                   backward->cam_from_world[n]),
              1e-7);
  }
}

// Every view is measured to six others or so, any of which may be false.
RotationGraph AnyGraph(double false_share, std::uint64_t seed) {
  constexpr std::uint32_t kNumViews = 20;
  RotationGraph graph;
  Random random(seed);
  graph.truth = RandomRotations(kNumViews, &random);
  const auto add = [&](std::size_t first, std::size_t second) {
    const bool is_false = random.Uniform() < false_share;
    const Vec3 noise = GaussianVector(&random, 0.003);
    graph.Add(first, second, is_false ? RandomVector(&random, 1.8) : noise,
              is_false);
    graph.measurements.back().cost = -random.Uniform(10, 100);
  };
  for (std::uint32_t n = 1; n < kNumViews; ++n) add(random.Index(n), n);
  while (graph.measurements.size() < 3 * kNumViews) {
    const std::size_t first = random.Index(kNumViews);
    const std::size_t second = random.Index(kNumViews);
    if (first != second) add(first, second);
  }
  return graph;
}

TEST(AverageRotations, IsNoWorseThanTheTruthWhereTwoInFiveAreFalse) {
  int worse = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RotationGraph graph = AnyGraph(0.4, seed);
    const auto result =
        AverageRotations(graph.truth.size(), graph.measurements);
    std::vector<RotationMeasurement> right;
    for (std::size_t e = 0; e < graph.measurements.size(); ++e) {
      if (!graph.is_false[e]) right.push_back(graph.measurements[e]);
    }
    const auto expected = AverageRotations(graph.truth.size(), right);
    ASSERT_TRUE(result && expected);
    worse += RobustCost(graph.measurements, result->cam_from_world) >
             RobustCost(graph.measurements, expected->cam_from_world) + 1;
  }
  EXPECT_LE(worse, 1);
}

TEST(AverageRotations, IsTheSameToTheByteInAnyOrder) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const RotationGraph graph = AnyGraph(0.4, seed);
    std::vector<RotationMeasurement> measurements = graph.measurements;
    const auto forward = AverageRotations(graph.truth.size(), measurements);
    std::reverse(measurements.begin(), measurements.end());
    const auto backward = AverageRotations(graph.truth.size(), measurements);
    ASSERT_TRUE(forward && backward);
    EXPECT_EQ(forward->cam_from_world, backward->cam_from_world);
    std::vector<double> residuals_rad = backward->residuals_rad;
    std::reverse(residuals_rad.begin(), residuals_rad.end());
    EXPECT_EQ(forward->residuals_rad, residuals_rad);
  }
}

TEST(AverageRotations, RefusesBadMeasurements) {
  RotationMeasurement m;
  m.first = 0;
  m.second = 5;
  EXPECT_EQ(AverageRotations(3, {m}).error().code, ErrorCode::kInvalidArgument);
  m.second = 1;
  m.stddev_rad = 0;
  EXPECT_EQ(AverageRotations(3, {m}).error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace lowlap
