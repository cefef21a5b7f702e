#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/scale/scale_estimator.h"
#include "scale/synthetic_planes.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticPlanes;
using testing::SyntheticPlanes;
using testing::SyntheticPlanesOptions;

ScaleRatio Estimate(const TripletView& view) {
  ScaleOptions options;
  options.use_coplanar_points = true;
  return MakeScaleEstimator(options)->Estimate(view).value();
}

TEST(RatioFromPlanes, IsFoundWithoutAnySharedFeature) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  constexpr int kTriplets = 60;
  int meaningful = 0, within = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, seed);
    const ScaleRatio ratio = Estimate(scene.View());
    if (ratio.verdict != RatioVerdict::kMeaningful) continue;
    ++meaningful;
    const double error = ratio.log_ratio - scene.true_log_ratio;
    EXPECT_LT(std::abs(error), 0.05) << "seed " << seed;
    within += std::abs(error) < 2 * ratio.log_ratio_stddev;
    EXPECT_EQ(ratio.coplanar.candidates,
              static_cast<int>(scene.Points().size()));
    EXPECT_GT(ratio.coplanar.inliers, 0);
    EXPECT_LT(ratio.coplanar.log10_nfa, 0);
  }
  EXPECT_GT(meaningful, 0.9 * kTriplets);
  EXPECT_GT(within, 0.85 * meaningful);
}

TEST(RatioFromPlanes, SurvivesSomeWrongPlanes) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  constexpr int kTriplets = 40;
  int right = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, seed);
    TripletView view = scene.View();
    options.unrelated_walls = true;
    const std::vector<PlanePoint> wrong =
        MakeSyntheticPlanes(options, seed).Points();
    options.unrelated_walls = false;
    for (std::size_t n = 0; n < wrong.size() && n < 3; ++n) {
      view.plane_points.push_back(wrong[n]);
    }
    const ScaleRatio ratio = Estimate(view);
    right += ratio.verdict == RatioVerdict::kMeaningful &&
             std::abs(ratio.log_ratio - scene.true_log_ratio) < 0.05;
  }
  EXPECT_GT(right, 0.8 * kTriplets);
}

TEST(RatioFromPlanes, IsSeldomMeaningfulForUnrelatedPlanes) {
  SyntheticPlanesOptions options;
  options.unrelated_walls = true;
  options.noise_px = 1;
  constexpr int kTriplets = 600;
  int meaningful = 0, with_points = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const TripletView view = MakeSyntheticPlanes(options, seed).View();
    with_points += !view.plane_points.empty();
    meaningful += Estimate(view).verdict == RatioVerdict::kMeaningful;
  }
  EXPECT_LE(meaningful, kTriplets / 100);
  EXPECT_GT(with_points, kTriplets / 2);
}

TEST(RatioFromPlanes, IsInvertedWhenTheEndsAreSwapped) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 3);
  TripletView swapped = scene.View();
  swapped.geometry = swapped.geometry.Swapped();
  for (PlanePoint& point : swapped.plane_points) {
    std::swap(point.point.in_i, point.point.in_k);
    point.ratio.log_ratio *= -1;
  }
  const ScaleRatio a = Estimate(scene.View()), b = Estimate(swapped);
  EXPECT_NEAR(a.log_ratio, -b.log_ratio, 1e-4);
  EXPECT_NEAR(a.log10_nfa, b.log10_nfa, 0.05);
}

}  // namespace
}  // namespace lowlap
