// From how many photographs on one index of all points pays off, in the choice
// of pairs: "times_faster" is the processor time of comparing every two views
// over that of the index.
#include <benchmark/benchmark.h>

#include <climits>

#include "benchmarks/processor_time.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/pair_retrieval.h"

namespace lowlap {
namespace {

using testing::ProcessorSeconds;

// A walk along a wall: every view shares most of its points with the next.
std::map<ViewId, DetectedFeatures> Walk(std::size_t num_views) {
  constexpr std::size_t kPoints = 500, kStep = 100;
  std::map<ViewId, DetectedFeatures> features;
  for (std::size_t n = 0; n < num_views; ++n) {
    DetectedFeatures& view = features[static_cast<ViewId>(n)];
    view.keypoints.resize(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      Random random(n * kStep + i);
      PointDescriptor descriptor;
      for (std::uint8_t& value : descriptor) {
        value = static_cast<std::uint8_t>(random.Index(256));
      }
      view.point_descriptors.push_back(descriptor);
    }
  }
  return features;
}

void PairRetrieval(benchmark::State& state) {
  const auto features = Walk(static_cast<std::size_t>(state.range(0)));
  RetrievalOptions by_index;
  by_index.max_exhaustive = 0;
  RetrievalOptions exhaustive;
  exhaustive.max_exhaustive = INT_MAX;
  double index_s = 0, exhaustive_s = 0;
  for (auto _ : state) {
    index_s += ProcessorSeconds([&] {
      benchmark::DoNotOptimize(RetrievePairs(features, by_index, RunContext()));
    });
    exhaustive_s += ProcessorSeconds([&] {
      benchmark::DoNotOptimize(
          RetrievePairs(features, exhaustive, RunContext()));
    });
  }
  state.counters["times_faster"] = exhaustive_s / index_s;
}
BENCHMARK(PairRetrieval)
    ->Arg(100)
    ->Arg(200)
    ->Arg(350)
    ->Arg(500)

    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
