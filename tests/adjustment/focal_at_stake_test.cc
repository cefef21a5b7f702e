#include "lowlap/adjustment/internal/calibration/focal_at_stake.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "test_scene.h"

namespace lowlap {
namespace {

using test::BuildAndAdjust;
using test::MakeTestScene;
using test::NormalisedCenterError;
using test::TestScene;
using test::TestSceneOptions;

// Points of two views each: they do not hold the scene together, and say
// nothing of a calibration. The focal length is off by the factor.
TestScene HeldByLines(std::uint64_t seed, double factor) {
  TestSceneOptions options;
  options.num_points = 60;
  options.max_point_views = 2;
  options.num_lines = 80;
  options.max_line_views = 4;
  options.pairs_per_triplet = 5;
  options.noise_px = 0.5;
  options.seed = seed;
  TestScene test = MakeTestScene(options);
  for (auto& entry : test.scene.intrinsics) {
    entry.second.fx_px *= factor;
    entry.second.fy_px *= factor;
  }
  return test;
}

AdjustmentOptions Untested() {
  AdjustmentOptions options;
  options.test_calibration = false;
  return options;
}

StructureState StateOf(const Scene& scene) {
  const CameraSet cameras(scene);
  StructureState state;
  state.points = LoadPoints(scene, cameras);
  state.lines = LoadLines(scene, cameras, false);
  return state;
}

// Of the focal lengths of an adjusted scene.
std::vector<double> FactorsAtStake(const Scene& scene,
                                   const StructureState& state,
                                   const AdjustmentSummary& summary,
                                   const AdjustmentOptions& options = {}) {
  NoiseLevels noise;
  noise.points = {summary.points.stddev_px, summary.points.threshold_px};
  noise.lines = {summary.lines.stddev_px, summary.lines.threshold_px};
  return FocalFactorsAtStake(options, noise, scene, CameraSet(scene), state);
}

// Of the only one.
double FactorAtStake(const Scene& scene, const StructureState& state,
                     const AdjustmentSummary& summary,
                     const AdjustmentOptions& options = {}) {
  const std::vector<double> factors =
      FactorsAtStake(scene, state, summary, options);
  EXPECT_EQ(factors.size(), 1u);
  return factors.front();
}

TEST(FocalAtStake, LeadsMostOfTheWayToTheTrueOne) {
  for (const double factor : {0.9, 1.1}) {
    TestScene test = HeldByLines(1, factor);
    const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
    EXPECT_TRUE(summary.calibration_preferences.empty());
    const double way =
        (FactorAtStake(test.scene, StateOf(test.scene), summary) - 1) /
        (1 / factor - 1);
    EXPECT_GT(way, 0.5) << factor;
    EXPECT_LT(way, 1.5) << factor;
  }
}

TEST(FocalAtStake, OfTwoIntrinsicsIsThatOfTheOneThatIsHeld) {
  constexpr double kFactor = 0.9;
  TestScene test = HeldByLines(1, kFactor);
  Scene& scene = test.scene;
  const auto [first, intrinsic] = *scene.intrinsics.begin();
  const IntrinsicId second(first.value() + 1);
  scene.intrinsics.emplace(second, intrinsic);
  int count = 0;
  for (auto& entry : scene.views) {
    if (count++ % 2 == 1) entry.second.intrinsic_id = second;
  }
  const AdjustmentSummary summary = BuildAndAdjust(&scene);
  const IntrinsicId ids[] = {first, second};
  for (const std::size_t held : {0, 1}) {
    AdjustmentOptions options;
    options.refine_intrinsics[ids[1 - held]].focal = true;
    const std::vector<double> factors =
        FactorsAtStake(scene, StateOf(scene), summary, options);
    ASSERT_EQ(factors.size(), 2u);
    EXPECT_EQ(factors[1 - held], 1);
    const double way = (factors[held] - 1) / (1 / kFactor - 1);
    EXPECT_GT(way, 0.5) << held;
    EXPECT_LT(way, 1.5) << held;
  }
}

TEST(FocalAtStake, IsNoneOfOneThatIsRefined) {
  TestScene test = HeldByLines(1, 0.9);
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  AdjustmentOptions options;
  for (const auto& entry : test.scene.intrinsics) {
    options.refine_intrinsics[entry.first].focal = true;
  }
  EXPECT_EQ(FactorAtStake(test.scene, StateOf(test.scene), summary, options),
            1);
}

// What is tied to what was found under the calibration that is held.
TEST(FocalAtStake, TiesToPlanesHaveNoPart) {
  TestScene test = HeldByLines(1, 0.9);
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene);
  StructureState state = StateOf(test.scene);
  const double without = FactorAtStake(test.scene, state, summary);
  ASSERT_NE(without, 1);
  PlaneState plane;
  plane.anchor = state.points.front().position;
  plane.thickness = 0.01;
  for (std::size_t n = 0; n < state.points.size(); ++n) {
    if (state.points[n].IsLandmark()) {
      plane.points.push_back({static_cast<int>(n), 1});
    }
  }
  for (std::size_t n = 0; n < state.lines.size(); ++n) {
    if (state.lines[n].IsLandmark()) {
      plane.lines.push_back({static_cast<int>(n), 1});
    }
  }
  state.planes.push_back(plane);
  EXPECT_EQ(FactorAtStake(test.scene, state, summary), without);
}

TEST(FocalAtStake, IsInTheDeviationsOfCentres) {
  constexpr int kSeeds = 2;
  for (const double factor : {0.9, 1.1}) {
    double with = 0, without = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      TestScene stated = HeldByLines(seed, factor), silent = stated;
      const AdjustmentSummary summary = BuildAndAdjust(&stated.scene);
      EXPECT_TRUE(summary.calibration_preferences.empty());
      BuildAndAdjust(&silent.scene, Untested());
      with += NormalisedCenterError(stated) / kSeeds;
      without += NormalisedCenterError(silent) / kSeeds;
    }
    EXPECT_GT(without, 10);
    EXPECT_LT(with, 3);
    EXPECT_GT(with, 0.3);
  }
}

double SumOfVariances(const Scene& scene) {
  double sum = 0;
  for (const auto& entry : scene.poses) {
    sum += entry.second.center_covariance->trace();
  }
  return sum;
}

// Nothing where noise explains what the images prefer; else never less.
TEST(FocalAtStake, AddsLittleToATrueOne) {
  constexpr int kSeeds = 6;
  double with = 0, without = 0;
  int unchanged = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    TestScene tested = HeldByLines(seed, 1), untested = tested;
    BuildAndAdjust(&tested.scene);
    BuildAndAdjust(&untested.scene, Untested());
    const double stated = SumOfVariances(tested.scene);
    const double silent = SumOfVariances(untested.scene);
    EXPECT_GE(stated, silent);
    unchanged += stated == silent ? 1 : 0;
    with += stated;
    without += silent;
  }
  EXPECT_GT(unchanged, 0);
  EXPECT_LT(with, 1.25 * without);
}

}  // namespace
}  // namespace lowlap
