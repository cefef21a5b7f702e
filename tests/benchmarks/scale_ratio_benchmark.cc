// What the ratio of a triplet costs. SweepTriplet: one triplet of `features`
// points, lines and coplanar pairs, 40, 20 and 40 percent of them; its time is
// the whole estimate of the ratio from its TripletView, and "sweep_ms" the part
// of the sweep. SweepAgainstExhaustive: "relative_cost" is the processor time
// over that of the search that tries the ratio of every feature.
// RatiosOfManyTriplets: the triplets of a scene by the number of threads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "benchmarks/processor_time.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scale/scale_ratios.h"
#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::ProcessorSeconds;

TripletView MixedTriplet(int num_features) {
  testing::SyntheticTripletOptions options;
  options.num_points = num_features * 4 / 10;
  options.num_lines = num_features * 2 / 10;
  // Every line has a few pairs near enough.
  const int num_pairs = num_features - options.num_points - options.num_lines;
  options.num_lines_ij = options.num_lines_jk = 20 + num_pairs / 8;
  options.noise_px = 0.7;
  options.wrong_share = 0.3;
  return testing::MakeSyntheticTriplet(options, 1).view;
}

void SweepTriplet(benchmark::State& state) {
  const TripletView view = MixedTriplet(static_cast<int>(state.range(0)));
  const auto estimator = MakeScaleEstimator({});
  for (auto _ : state) {
    benchmark::DoNotOptimize(estimator->Estimate(view));
  }
  const RatioSupport support(testing::Gather(view));
  const RatioNfaCriterion criterion(support, view, NfaForm::kCalibrated);
  state.counters["features"] = static_cast<double>(support.hypotheses().size());
  state.counters["sweep_ms"] =
      1e3 * ProcessorSeconds([&] { SweepRatios(support, criterion); });
  state.SetComplexityN(state.range(0));
}
BENCHMARK(SweepTriplet)
    ->ArgName("features")
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);

void SweepAgainstExhaustive(benchmark::State& state) {
  const TripletView view = MixedTriplet(static_cast<int>(state.range(0)));
  ScaleOptions options;
  const auto sweep = MakeScaleEstimator(options);
  options.search = RatioSearch::kExhaustive;
  const auto exhaustive = MakeScaleEstimator(options);
  double ours = 0, reference = 0, our_nfa = 0, reference_nfa = 0;
  for (auto _ : state) {
    ours +=
        ProcessorSeconds([&] { our_nfa = sweep->Estimate(view)->log10_nfa; });
    reference += ProcessorSeconds(
        [&] { reference_nfa = exhaustive->Estimate(view)->log10_nfa; });
  }
  state.counters["relative_cost"] = ours / reference;
  state.counters["log10_nfa"] = our_nfa;
  state.counters["reference_log10_nfa"] = reference_nfa;
}
BENCHMARK(SweepAgainstExhaustive)
    ->ArgName("features")
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

// Views in a row before a tilted wall of points.
Scene RowOfViews() {
  constexpr int kViews = 12, kPoints = 1500;
  Scene scene;
  Intrinsic intrinsic;
  intrinsic.width_px = 1200;
  intrinsic.height_px = 800;
  intrinsic.fx_px = intrinsic.fy_px = 900;
  intrinsic.principal_point_px = {600, 400};
  scene.intrinsics[0] = intrinsic;
  Random random(5);
  std::vector<RigidTransform> cams;
  for (std::uint32_t view = 0; view < kViews; ++view) {
    scene.views[view].intrinsic_id = 0;
    scene.views[view].pose_id = view;
    cams.push_back(RigidTransform::FromRotationAndCenter(
        RotationFromAngleAxis({0, 0.02 * view, 0.01}),
        Vec3(0.3 * view + 0.01 * view * view, 0.05 * view, 0)));
  }
  for (int n = 0; n < kPoints; ++n) {
    const double x = random.Uniform(-0.8, 3.2);
    const Vec3 point(x, random.Uniform(-1.3, 1.3), 4 + 0.4 * x);
    for (std::uint32_t view = 0; view < kViews; ++view) {
      const double u = random.Gaussian(0.5);
      const Vec2 noise(u, random.Gaussian(0.5));
      scene.features[view].points_px.push_back(
          Vec2(intrinsic.Project(cams[view] * point) + noise));
    }
  }
  for (std::uint32_t i = 0; i < kViews; ++i) {
    for (std::uint32_t j = i + 1; j < kViews; ++j) {
      const RigidTransform j_from_i = cams[j] * cams[i].Inverse();
      RelativePose pose;
      pose.views = {i, j};
      pose.rotation = j_from_i.rotation;
      pose.direction = j_from_i.translation.normalized();
      for (FeatureIndex n = 0; n < kPoints / (j - i); ++n) {
        pose.point_inliers.push_back({n, n});
      }
      scene.relative_poses[pose.views] = pose;
    }
  }
  return scene;
}

void RatiosOfManyTriplets(benchmark::State& state) {
  const Scene scene = RowOfViews();
  RunContext context;
  context.num_threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(EstimateScaleRatios(scene, {}, context));
  }
}
BENCHMARK(RatiosOfManyTriplets)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
