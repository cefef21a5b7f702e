#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/internal/simulate_ratios.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;

SyntheticOptions GraphOnly(int num_views, const std::string& pairs) {
  SyntheticOptions options;
  options.num_views = num_views;
  options.pairs = pairs;
  options.points_per_wall = 0;
  options.lines_per_wall = 0;
  return options;
}

TEST(SimulateGraph, ALoopGoesOnFromTheLastViewToTheFirst) {
  const SyntheticScene window = *Simulate(GraphOnly(9, "window:2"));
  const SyntheticScene loop = *Simulate(GraphOnly(9, "loop:2"));
  EXPECT_EQ(window.scene.relative_poses.size(), 15u);
  EXPECT_EQ(loop.scene.relative_poses.size(), 18u);
  for (const ViewPair& pair :
       {ViewPair{0, 8}, ViewPair{0, 7}, ViewPair{1, 8}}) {
    EXPECT_EQ(window.scene.relative_poses.count(pair), 0u);
    EXPECT_EQ(loop.scene.relative_poses.count(pair), 1u);
  }
  // Pairs that both ways round propose are one pair.
  EXPECT_EQ(Simulate(GraphOnly(3, "loop:2"))->scene.relative_poses.size(), 3u);
}

TEST(SimulateGraph, FiveThousandViewsAreNoProblem) {
  SyntheticScene graph = *Simulate(GraphOnly(5000, "loop:4"));
  EXPECT_EQ(graph.scene.relative_poses.size(), 20'000u);
  SimulatedRatioOptions options;
  options.max_ratios = 60'000;
  ASSERT_TRUE(SimulateRatios(options, &graph));
  EXPECT_EQ(graph.scene.scale_ratios.size(), 60'000u);
}

TEST(SimulateGraph, TwinsAndLinesAreAsDegenerateAsAskedFor) {
  SyntheticOptions twins = GraphOnly(8, "chain");
  twins.kind = SyntheticKind::kTwins;
  twins.twin_baseline_m = 0.01;
  const SyntheticScene made = *Simulate(twins);
  for (const auto& [pair, length] : made.true_baselines) {
    if (pair.first.value() % 2 == 0) {
      EXPECT_NEAR(length, 0.01, 1e-12);
    } else {
      EXPECT_GT(length, 0.1);
    }
  }
  SyntheticOptions line = GraphOnly(40, "chain");
  line.kind = SyntheticKind::kCollinear;
  const auto distance_from_line = [&](double off_line_m) {
    line.off_line_m = off_line_m;
    const SyntheticScene scene = *Simulate(line);
    const Vec3 origin = Simulate(line)->true_poses.at(0).center;
    const Vec3 along = (scene.true_poses.at(39).center - origin).normalized();
    double largest = 0;
    for (const auto& [view, pose] : scene.true_poses) {
      const Vec3 offset = pose.center - origin;
      largest = std::max(largest, (offset - along * along.dot(offset)).norm());
    }
    return largest;
  };
  EXPECT_LT(distance_from_line(0), 1e-12);
  EXPECT_GT(distance_from_line(0.05), 0.05);
  EXPECT_LT(distance_from_line(0.05), 0.4);
}

TEST(SimulateGraph, WrongDirectionsAreAsManyAsAskedFor) {
  SyntheticOptions options = GraphOnly(500, "loop:4");
  const SyntheticScene right = *Simulate(options);
  options.wrong_direction_share = 0.3;
  const SyntheticScene wrong = *Simulate(options);
  int count = 0;
  for (const auto& [pair, edge] : wrong.scene.relative_poses) {
    const RelativePose& before = right.scene.relative_poses.at(pair);
    EXPECT_EQ(edge.rotation, before.rotation);
    if (edge.direction != before.direction) ++count;
  }
  EXPECT_NEAR(count, 600, 70);
}

TEST(SimulateGraph, WrongPosesAreAsManyAsAskedForAndSpoilTheirRatios) {
  SyntheticOptions options = GraphOnly(500, "loop:4");
  const SyntheticScene right = *Simulate(options);
  options.wrong_pose_share = 0.3;
  SyntheticScene wrong = *Simulate(options);
  std::set<ViewPair> changed;
  for (const auto& [pair, edge] : wrong.scene.relative_poses) {
    const RelativePose& before = right.scene.relative_poses.at(pair);
    EXPECT_TRUE(edge.rotation.isUnitary(1e-9));
    // Rotations of less than the bound of SimulatedRatioOptions are rare.
    if (RotationAngleBetween(edge.rotation, before.rotation) > RadFromDeg(10)) {
      EXPECT_NE(edge.direction, before.direction);
      changed.insert(pair);
    }
  }
  EXPECT_NEAR(static_cast<double>(changed.size()), 600, 70);

  SimulatedRatioOptions ratios;
  ratios.wrong_beside_wrong_poses = true;
  ASSERT_TRUE(SimulateRatios(ratios, &wrong));
  const auto is_changed = [&](ViewId a, ViewId b) {
    return changed.count({std::min(a, b), std::max(a, b)}) > 0;
  };
  for (const ScaleRatio& ratio : wrong.scene.scale_ratios) {
    const double error =
        std::abs(ratio.log_ratio - *wrong.TrueLogRatio(ratio.views));
    EXPECT_EQ(error > 0.09,
              is_changed(ratio.views.first, ratio.views.middle) ||
                  is_changed(ratio.views.middle, ratio.views.last));
  }
}

// The error over its covariance is a chi-square of five degrees of freedom,
// whose median is 4.35. (Where a pair has hardly a match, errors are too large
// to be linear: the median does not mind.)
TEST(SimulateGraph, PoseErrorsHaveTheCovarianceTheyState) {
  SyntheticOptions options;
  options.num_views = 12;
  options.pairs = "loop:3";
  options.noise_px = 1;
  options.pose_noise_factor = 1;
  std::vector<double> sizes;
  for (options.seed = 0; options.seed < 8; ++options.seed) {
    const SyntheticScene noisy = *Simulate(options);
    SyntheticOptions exact_options = options;
    exact_options.pose_noise_factor = 0;
    const SyntheticScene exact = *Simulate(exact_options);
    for (const auto& [pair, edge] : noisy.scene.relative_poses) {
      const RelativePose& truth = exact.scene.relative_poses.at(pair);
      Eigen::Matrix<double, 5, 1> error;
      error << AngleAxisFromRotation(edge.rotation *
                                     truth.rotation.transpose()),
          TangentBasis(truth.direction).transpose() * edge.direction;
      ASSERT_TRUE(edge.covariance);
      sizes.push_back(error.dot(edge.covariance->llt().solve(error)));
    }
  }
  ASSERT_GT(sizes.size(), 200u);
  EXPECT_NEAR(Median(sizes), 4.35, 0.5);
}

// The direction of two views in almost one place is open.
TEST(SimulateGraph, TinyBaselinesHaveUncertainDirections) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kTwins;
  options.num_views = 4;
  options.pairs = "chain";
  options.noise_px = 1;
  options.pose_noise_factor = 1;
  const auto deviation = [&](double baseline_m) {
    options.twin_baseline_m = baseline_m;
    const SyntheticScene scene = *Simulate(options);
    return std::sqrt(scene.scene.relative_poses.at({0, 1})
                         .covariance->bottomRightCorner<2, 2>()
                         .trace());
  };
  EXPECT_LT(deviation(0.5), 0.02);
  EXPECT_GT(deviation(0.001), 0.2);
}

TEST(SimulateRatios, ErrorsAreAsStatedAndWrongOnesAreFarOff) {
  SyntheticScene graph = *Simulate(GraphOnly(400, "loop:3"));
  SimulatedRatioOptions options;
  options.log_stddev = 0.03;
  options.wrong_share = 0.4;
  ASSERT_TRUE(SimulateRatios(options, &graph));
  double squares = 0;
  int right = 0, wrong = 0;
  for (const ScaleRatio& ratio : graph.scene.scale_ratios) {
    EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
    EXPECT_LT(ratio.log10_nfa, 0);
    const double error = ratio.log_ratio - *graph.TrueLogRatio(ratio.views);
    if (std::abs(error) < std::log(options.min_factor) - 0.05) {
      squares += error * error;
      ++right;
    } else {
      EXPECT_LT(std::abs(error), std::log(options.max_factor) + 0.15);
      ++wrong;
    }
  }
  EXPECT_EQ(right + wrong, 400 * 15);
  EXPECT_NEAR(wrong, 2400, 200);
  EXPECT_NEAR(std::sqrt(squares / right), 0.03, 0.003);
}

TEST(SimulateRatios, MoreWrongOnesAreTheSameAndMore) {
  SyntheticScene graph = *Simulate(GraphOnly(60, "window:3"));
  SimulatedRatioOptions options;
  std::set<ViewTriplet> before;
  for (const double share : {0.1, 0.4, 0.9}) {
    options.wrong_share = share;
    ASSERT_TRUE(SimulateRatios(options, &graph));
    std::set<ViewTriplet> wrong;
    for (const ScaleRatio& ratio : graph.scene.scale_ratios) {
      const double error = ratio.log_ratio - *graph.TrueLogRatio(ratio.views);
      if (std::abs(error) > 0.1) wrong.insert(ratio.views);
    }
    for (const ViewTriplet& views : before) EXPECT_EQ(wrong.count(views), 1u);
    EXPECT_GT(wrong.size(), before.size());
    before = wrong;
  }
}

TEST(SimulateRatios, EveryBadValueIsNamed) {
  SyntheticScene graph = *Simulate(GraphOnly(4, "chain"));
  SimulatedRatioOptions options;
  options.log_stddev = 0;
  EXPECT_THAT(SimulateRatios(options, &graph),
              IsError(ErrorCode::kInvalidArgument, "log_stddev"));
  options = {};
  options.wrong_share = 1.5;
  EXPECT_THAT(SimulateRatios(options, &graph),
              IsError(ErrorCode::kInvalidArgument, "wrong_share"));
  options = {};
  options.min_factor = 1;
  EXPECT_THAT(SimulateRatios(options, &graph),
              IsError(ErrorCode::kInvalidArgument, "min_factor"));
}

}  // namespace
}  // namespace lowlap
