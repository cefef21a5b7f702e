// What it costs to average the lengths and centres of a large graph. Counters:
// the processor time in units of one sparse factorisation of the graph in the
// same run, so that machines and loads compare; the median position error, and
// the same without the wrong ratios; neighbours are a metre apart.
//
// AnswerToStop: how long a host waits for what it asked to stop. Counters:
// answer_s, the longest wait of a few requests, on the wall's clock; gap_s, the
// longest time without a question, which no request waits longer than, in
// processor time and so without the load of the machine; run_s, the wall time
// of the run that gap_s is of, which is stopped in the end if need be.
#include <benchmark/benchmark.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "averaging/big_graph.h"
#include "averaging/rotations/random_rotation_graph.h"
#include "benchmarks/processor_time.h"
#include "lowlap/averaging/averager_registry.h"
#include "lowlap/averaging/scales/internal/edge_scales.h"
#include "lowlap/averaging/scales/internal/refine_centers.h"
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

// Solves the graph once a round; counts its time in factorizations.
Result<TranslationSolution> SolveTimed(const TranslationProblem& problem,
                                       benchmark::State* state) {
  Result<TranslationSolution> solution;
  double seconds = 0;
  for (auto _ : *state) {
    seconds += testing::ProcessorSeconds(
        [&] { solution = GraphScalesAverager().Solve(problem, RunContext()); });
    if (!solution) {
      state->SkipWithError("the graph was not solved");
      return solution;
    }
  }
  state->counters["factorizations"] = seconds /
                                      static_cast<double>(state->iterations()) /
                                      FactorizationSeconds(problem);
  return solution;
}

void CentersOfGraph(benchmark::State& state) {
  const BigGraph graph = GraphOf(state);
  const auto solution = SolveTimed(graph.made.problem, &state);
  if (!solution) return;
  state.counters["error_m"] = MedianCenterError(graph.made, *solution);
  const auto oracle = GraphScalesAverager().Solve(graph.oracle, RunContext());
  if (!oracle) return state.SkipWithError("the graph was not solved");
  state.counters["oracle_error_m"] = MedianCenterError(graph.made, *oracle);
}

// Views that directions place one after the other (a town), and a street where
// every pair is a part of its own.
void CentersWithoutRatios(benchmark::State& state) {
  const bool is_town = state.range(0) != 0;
  BigGraphOptions options;
  options.shape = is_town ? GraphShape::kTown : GraphShape::kStreet;
  options.num_views = static_cast<std::size_t>(state.range(1));
  options.num_edges = is_town ? 5 * options.num_views : options.num_views - 1;
  options.num_ratios = 0;
  options.direction_stddev_rad = 0.001;
  const BigGraph graph = MakeBigGraph(options);
  const auto solution = SolveTimed(graph.made.problem, &state);
  if (!solution) return;
  state.counters["placed"] = solution->NumPlaced();
}
BENCHMARK(CentersWithoutRatios)
    ->ArgNames({"town", "views"})
    ->Unit(benchmark::kMillisecond)
    ->ArgsProduct({{0, 1}, {500, 2000}});

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

double WallSeconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// One run that is asked to stop after some seconds.
struct StoppedRun {
  double seconds = 0;
  double answer_s = 0;  // from the request to the return; 0: it was done before
  double gap_s = 0;     // processor time
  double gap_begin_s = 0;
};

using Run = std::function<void(const RunContext&)>;

StoppedRun RunAndStop(const Run& run, double stop_after_s) {
  StoppedRun stopped;
  const double begin = WallSeconds();
  double asked_at = 0, processor = testing::ProcessorSecondsNow();
  const auto end_gap = [&] {
    const double now = testing::ProcessorSecondsNow();
    if (now - processor > stopped.gap_s) {
      stopped.gap_s = now - processor;
      stopped.gap_begin_s = asked_at;
    }
    processor = now;
    asked_at = WallSeconds() - begin;
  };
  RunContext context;
  context.num_threads = 1;
  context.progress = [&](const std::string&, std::size_t, std::size_t) {
    end_gap();
    return asked_at < stop_after_s;
  };
  run(context);
  end_gap();
  stopped.seconds = asked_at;
  stopped.answer_s = std::max(0.0, stopped.seconds - stop_after_s);
  return stopped;
}

// Requests at once, as the longest gap begins, and spread over the run.
void MeasureAnswers(const Run& run, benchmark::State* state) {
  constexpr double kMostSeconds = 20;
  StoppedRun whole;
  double answer_s = 0;
  for (auto _ : *state) {
    whole = RunAndStop(run, kMostSeconds);
    answer_s = std::max(answer_s, whole.answer_s);
    for (const double moment :
         {0.0, whole.gap_begin_s + 1e-6, whole.seconds / 4, whole.seconds / 2,
          3 * whole.seconds / 4}) {
      answer_s = std::max(answer_s, RunAndStop(run, moment).answer_s);
    }
  }
  state->counters["answer_s"] = answer_s;
  state->counters["gap_s"] = whole.gap_s;
  state->counters["gap_at_s"] = whole.gap_begin_s;
  state->counters["run_s"] = whole.seconds;
}

// A graph with points around its views, each seen by a view and its neighbours.
TranslationProblem ProblemWithTracks(const BigGraphOptions& options) {
  constexpr int kTracksPerView = 20;
  BigGraph graph = MakeBigGraph(options);
  TranslationProblem problem = std::move(graph.made.problem);
  std::vector<std::vector<std::size_t>> seen_by(options.num_views);
  for (std::size_t n = 0; n < options.num_views; ++n) seen_by[n].push_back(n);
  for (const DirectionEdge& edge : problem.edges) {
    seen_by[edge.first].push_back(edge.second);
    seen_by[edge.second].push_back(edge.first);
  }
  Random random(options.seed);
  for (std::size_t n = 0; n < options.num_views; ++n) {
    std::sort(seen_by[n].begin(), seen_by[n].end());
    for (int k = 0; k < kTracksPerView; ++k) {
      const Vec3 point = graph.made.centers[n] + RandomVector(&random, 5.0);
      TrackRays track;
      for (const std::size_t view : seen_by[n]) {
        const Vec3 ray = (point - graph.made.centers[view]).normalized() +
                         RandomVector(&random, 0.001);
        track.observations.push_back({view, ray.normalized()});
      }
      problem.tracks.push_back(std::move(track));
    }
  }
  return problem;
}

void AnswerToStop(benchmark::State& state, const std::string& request,
                  const BigGraphOptions& options) {
  const auto averager = AveragerRegistry::WithBuiltIns().Make(request);
  const TranslationProblem problem = ProblemWithTracks(options);
  MeasureAnswers(
      [&](const RunContext& context) {
        benchmark::DoNotOptimize((*averager)->Solve(problem, context));
      },
      &state);
}

void AnswerOfRotations(benchmark::State& state) {
  const RotationGraph graph = MakeRotationGraph(5000, 4, 0.1, 1.0, 1);
  MeasureAnswers(
      [&](const RunContext& context) {
        benchmark::DoNotOptimize(
            AverageRotations(5000, graph.measurements, {}, context));
      },
      &state);
}

void AnswerOfRefinement(benchmark::State& state) {
  const BigGraph graph = MakeBigGraph(BigGraphOptions());
  const std::vector<bool> placed(graph.made.centers.size(), true);
  MeasureAnswers(
      [&](const RunContext& context) {
        std::vector<Vec3> centers = graph.made.centers;
        benchmark::DoNotOptimize(
            RefineCenters(graph.made.problem, placed, &centers, context));
      },
      &state);
}

void RegisterAnswers() {
  const auto once = [](benchmark::internal::Benchmark* benchmark) {
    benchmark->Unit(benchmark::kSecond)->Iterations(1);
  };
  once(benchmark::RegisterBenchmark("AnswerToStop/rotations",
                                    AnswerOfRotations));
  once(benchmark::RegisterBenchmark("AnswerToStop/refinement",
                                    AnswerOfRefinement));
  const auto add = [&](const std::string& request, const char* name,
                       const BigGraphOptions& options) {
    once(benchmark::RegisterBenchmark(
        ("AnswerToStop/" + request + "/" + name).c_str(), AnswerToStop, request,
        options));
  };
  std::vector<std::string> requests = AveragerRegistry::WithBuiltIns().Names();
  requests.push_back("1dsfm+chain");
  BigGraphOptions town;
  BigGraphOptions street = town;
  street.shape = GraphShape::kStreet;
  BigGraphOptions random = town;
  random.shape = GraphShape::kRandom;
  // Most lengths are for the directions to find out.
  BigGraphOptions sparse = town;
  sparse.num_ratios = 6000;
  for (const std::string& request : requests) {
    add(request, "town", town);
    add(request, "street", street);
    add(request, "random", random);
    add(request, "town_of_few_ratios", sparse);
  }
  // The largest graphs that the simplex method takes.
  for (const auto& [request, views] :
       {std::pair<const char*, std::size_t>{"linf", 1000}, {"l1_lp", 350}}) {
    BigGraphOptions small = street;
    small.num_views = views;
    small.num_edges = 4 * views;
    small.num_ratios = 12 * views;
    add(request, "short_street", small);
  }
}

}  // namespace
}  // namespace lowlap

int main(int argc, char** argv) {
  lowlap::RegisterAnswers();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
