#include "lowlap/adjustment/internal/costs/scale_ratio_prior.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iterator>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using Centers = std::array<Vec3, 3>;

double ResidualAt(const ScaleRatioCost& cost, const Centers& centers) {
  const double* const blocks[] = {centers[0].data(), centers[1].data(),
                                  centers[2].data()};
  double residual = 0;
  EXPECT_TRUE(cost.Evaluate(blocks, &residual, nullptr));
  return residual;
}

double LogRatioOf(const Vec3& first, const Vec3& middle, const Vec3& last) {
  return std::log((last - middle).norm() / (middle - first).norm());
}

// A solved chain; its ratios are the true ones.
Scene TrueChain() {
  SyntheticOptions options;
  options.num_views = 5;
  options.pairs = "chain";
  const SyntheticScene synthetic = *Simulate(options);
  Scene scene = TrueSolution(synthetic);
  scene.scale_ratios.clear();
  const auto center = [&](std::uint32_t view) {
    return scene.poses.at(scene.views.at(ViewId(view)).pose_id).center;
  };
  for (std::uint32_t n = 0; n + 2 < 5; ++n) {
    ScaleRatio ratio;
    ratio.views = {ViewId(n), ViewId(n + 1), ViewId(n + 2)};
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log_ratio = LogRatioOf(center(n), center(n + 1), center(n + 2));
    ratio.log_ratio_stddev = 0.001;
    scene.scale_ratios.push_back(ratio);
  }
  return scene;
}

TEST(ScaleRatioPrior, CountsDeviations) {
  const Centers centers = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 2, 0)};
  EXPECT_NEAR(ResidualAt({std::log(2.0), 0.05}, centers), 0, 1e-12);
  EXPECT_NEAR(ResidualAt({std::log(2.0) - 0.1, 0.05}, centers), 2, 1e-12);
}

TEST(ScaleRatioPrior, HasTheDerivativesOfItsResidual) {
  const ScaleRatioCost cost(0.3, 0.02);
  const Centers centers = {Vec3(0.2, -1, 0.4), Vec3(1, 0.3, -2),
                           Vec3(-1.5, 2, 0.7)};
  const double* const blocks[] = {centers[0].data(), centers[1].data(),
                                  centers[2].data()};
  double residual = 0;
  std::array<Vec3, 3> gradients;
  double* jacobians[] = {gradients[0].data(), gradients[1].data(),
                         gradients[2].data()};
  ASSERT_TRUE(cost.Evaluate(blocks, &residual, jacobians));
  constexpr double kStep = 1e-6;
  for (int block = 0; block < 3; ++block) {
    for (int axis = 0; axis < 3; ++axis) {
      Centers low = centers, high = centers;
      low[block][axis] -= kStep;
      high[block][axis] += kStep;
      EXPECT_NEAR(
          gradients[block][axis],
          (ResidualAt(cost, high) - ResidualAt(cost, low)) / (2 * kStep), 1e-6);
    }
  }
}

TEST(ScaleRatioPrior, FailsWithoutABaseline) {
  const Vec3 same(1, 2, 3), other(0, 0, 0);
  const double* const blocks[] = {same.data(), same.data(), other.data()};
  double residual = 0;
  EXPECT_FALSE(ScaleRatioCost(0, 1).Evaluate(blocks, &residual, nullptr));
}

TEST(ScaleRatioPrior, LeavesOutWhatIsFalseOrUnknown) {
  Scene scene = TrueChain();
  EXPECT_EQ(LoadScaleRatioPriors(scene, CameraSet(scene)).size(), 3u);
  scene.scale_ratios[0].log_ratio += 1;
  scene.scale_ratios[1].log_ratio_stddev = 0;
  EXPECT_EQ(LoadScaleRatioPriors(scene, CameraSet(scene)).size(), 1u);
}

TEST(ScaleRatioPrior, TrustsWhatChanceExplainsLess) {
  Scene scene = TrueChain();
  scene.scale_ratios[0].verdict = RatioVerdict::kNotMeaningful;
  const auto priors = LoadScaleRatioPriors(scene, CameraSet(scene));
  ASSERT_EQ(priors.size(), 3u);
  EXPECT_GT(priors[0].log_ratio_stddev, 4 * priors[1].log_ratio_stddev);
}

// Points of neighbours alone, and no coplanar pair: nothing but the ratios
// carries the scale.
TEST(ScaleRatioPrior, HoldsTheScaleThatNoStructureCarries) {
  Scene scene = TrueChain();
  scene.line_structure.clear();
  scene.line_tracks.clear();
  scene.coplanar_pairs.clear();
  scene.point_tracks.clear();
  for (auto landmark = scene.structure.begin();
       landmark != scene.structure.end();) {
    auto& observations = landmark->second.observations;
    observations.resize(2);
    const bool of_neighbours =
        observations[1].view.value() == observations[0].view.value() + 1;
    landmark =
        of_neighbours ? std::next(landmark) : scene.structure.erase(landmark);
  }
  const auto center = [&](std::uint32_t view) -> Vec3 {
    return scene.poses.at(scene.views.at(ViewId(view)).pose_id).center;
  };
  const double truth = LogRatioOf(center(2), center(3), center(4));
  // The last view closer by a fifth, with what is seen from there.
  const PoseId pose = scene.views.at(ViewId(4)).pose_id;
  const Vec3 moved = center(3) + 0.8 * (center(4) - center(3));
  scene.poses.at(pose).center = moved;
  AdjustmentOptions options;
  options.use_coplanar = false;
  const auto error_with = [&](bool ratios) {
    options.use_scale_ratios = ratios;
    Scene adjusted = scene;
    EXPECT_TRUE(AdjustScene(&adjusted, options, {}).has_value());
    const auto at = [&](std::uint32_t view) -> Vec3 {
      return adjusted.poses.at(adjusted.views.at(ViewId(view)).pose_id).center;
    };
    return std::abs(LogRatioOf(at(2), at(3), at(4)) - truth);
  };
  EXPECT_LT(error_with(true), 0.02);
  EXPECT_GT(error_with(false), 0.04);
}

}  // namespace
}  // namespace lowlap
