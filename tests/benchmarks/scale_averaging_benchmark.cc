// What it costs to average the lengths and centres of a large graph. Counters:
// the processor time in units of one sparse factorisation of the graph in the
// same run, so that machines and loads compare; the median position error, and
// the same without the wrong ratios; neighbours are a metre apart.
#include <benchmark/benchmark.h>

#include <Eigen/SparseCholesky>
#include <vector>

#include "averaging/big_graph.h"
#include "benchmarks/processor_time.h"
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

// Processor time of one factorisation of the views' Laplacian, the mean of a
// few.
double FactorizationSeconds(const TranslationProblem& problem) {
  const auto size = static_cast<int>(problem.views.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int n = 0; n < size; ++n) entries.emplace_back(n, n, 1e-6);
  for (const DirectionEdge& edge : problem.edges) {
    const auto a = static_cast<int>(edge.first);
    const auto b = static_cast<int>(edge.second);
    entries.emplace_back(a, a, 1.0);
    entries.emplace_back(b, b, 1.0);
    entries.emplace_back(a, b, -1.0);
    entries.emplace_back(b, a, -1.0);
  }
  Eigen::SparseMatrix<double> laplacian(size, size);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  constexpr int kRepetitions = 5;
  return testing::ProcessorSeconds([&] {
           for (int n = 0; n < kRepetitions; ++n) {
             Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(
                 laplacian);
             benchmark::DoNotOptimize(factors.info());
           }
         }) /
         kRepetitions;
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
  Result<TranslationSolution> solution;
  double seconds = 0;
  for (auto _ : state) {
    seconds += testing::ProcessorSeconds(
        [&] { solution = averager.Solve(graph.made.problem, RunContext()); });
    if (!solution) return state.SkipWithError("the graph was not solved");
  }
  state.counters["factorizations"] = seconds /
                                     static_cast<double>(state.iterations()) /
                                     FactorizationSeconds(graph.made.problem);
  state.counters["error_m"] = MedianCenterError(graph.made, *solution);
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
  benchmark->Args({static_cast<int>(GraphShape::kRandom), 5000, 20});
}
BENCHMARK(EdgeScalesOfGraph)->Apply(Arguments);
BENCHMARK(CentersOfGraph)->Apply(Arguments);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
