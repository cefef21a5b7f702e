// What it costs to average the lengths and centres of a large graph. Counters:
// the median position error, and the same without the wrong ratios; neighbours
// are a metre apart.
#include <benchmark/benchmark.h>

#include "averaging/big_graph.h"
#include "lowlap/averaging/scales/internal/edge_scales.h"
#include "lowlap/averaging/strategies/internal/graph_scales.h"

namespace lowlap {
namespace {

// Arguments: shape, views, percent of the ratios that are wrong.
BigGraph GraphOf(const benchmark::State& state) {
  BigGraphOptions options;
  options.shape = static_cast<GraphShape>(state.range(0));
  options.num_views = static_cast<std::size_t>(state.range(1));
  options.num_edges = 4 * options.num_views;
  options.num_ratios = 12 * options.num_views;
  options.wrong_ratio_share = 0.01 * static_cast<double>(state.range(2));
  return MakeBigGraph(options);
}

void EdgeScalesOfGraph(benchmark::State& state) {
  const BigGraph graph = GraphOf(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(AverageEdgeScales(graph.made.problem));
  }
}

void CentersOfGraph(benchmark::State& state) {
  const BigGraph graph = GraphOf(state);
  const GraphScalesAverager averager;
  double error = 0;
  for (auto _ : state) {
    const auto solution = averager.Solve(graph.made.problem, RunContext());
    if (!solution) return state.SkipWithError("the graph was not solved");
    error = MedianCenterError(graph.made, *solution);
  }
  state.counters["error_m"] = error;
  const auto oracle = averager.Solve(graph.oracle, RunContext());
  if (!oracle) return state.SkipWithError("the graph was not solved");
  state.counters["oracle_error_m"] = MedianCenterError(graph.made, *oracle);
}

void Arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"shape", "views", "wrong_percent"})
      ->Unit(benchmark::kMillisecond);
  for (const GraphShape shape : {GraphShape::kStreet, GraphShape::kTown}) {
    for (const int views : {500, 5000}) {
      benchmark->Args({static_cast<int>(shape), views, 20});
    }
  }
}
BENCHMARK(EdgeScalesOfGraph)->Apply(Arguments);
BENCHMARK(CentersOfGraph)->Apply(Arguments);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
