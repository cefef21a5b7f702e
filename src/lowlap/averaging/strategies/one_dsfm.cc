#include "lowlap/averaging/strategies/internal/one_dsfm.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/averaging/strategies/internal/vertex_order.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

Vec3 DrawAxis(const TranslationProblem& problem, std::uint64_t seed,
              std::uint64_t index) {
  Random random(seed, index);
  const std::size_t num_edges = problem.edges.size();
  const auto e = random.Index(static_cast<std::uint32_t>(num_edges));
  const double blur =
      0.5 * std::pow(static_cast<double>(num_edges), -1.0 / 6.0);
  Vec3 axis = problem.edges[e].direction_in_world;
  for (int n = 0; n < 3; ++n) axis(n) += random.Gaussian(blur);
  return axis.norm() > 0 ? Vec3(axis.normalized()) : Vec3::UnitX();
}

// The weight that the order of the views along one axis breaks, per edge.
std::vector<double> BrokenWeights(const TranslationProblem& problem,
                                  const Vec3& axis) {
  std::vector<WeightedArc> arcs;
  arcs.reserve(problem.edges.size());
  for (const DirectionEdge& edge : problem.edges) {
    const double along = edge.direction_in_world.dot(axis);
    arcs.push_back(along > 0 ? WeightedArc{edge.first, edge.second, along}
                             : WeightedArc{edge.second, edge.first, -along});
  }
  const std::vector<std::size_t> place =
      OrderVertices(problem.views.size(), arcs);
  std::vector<double> broken;
  broken.reserve(arcs.size());
  for (const WeightedArc& arc : arcs) {
    broken.push_back(place[arc.from] > place[arc.to] ? arc.weight : 0.0);
  }
  return broken;
}

std::vector<std::size_t> EdgesOnNoCycle(const TranslationProblem& problem) {
  std::map<ViewPair, std::vector<std::size_t>> edges_of_pair;
  std::vector<ViewPair> pairs;
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const DirectionEdge& edge = problem.edges[e];
    pairs.push_back(OrderedPair(static_cast<ViewId>(edge.first),
                                static_cast<ViewId>(edge.second)));
    edges_of_pair[pairs.back()].push_back(e);
  }
  const ViewGraph graph(std::move(pairs));
  std::vector<std::size_t> edges;
  for (const ViewPair& bridge : FindBridges(graph)) {
    const std::vector<std::size_t>& of_pair = edges_of_pair.at(bridge);
    // Two edges of one pair are a cycle.
    if (of_pair.size() == 1) edges.push_back(of_pair.front());
  }
  return edges;
}

}  // namespace

Status OneDSfmOptions::Validate() const {
  if (num_projections < 1 || !(max_contradiction >= 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "1DSfM: needs at least one projection, and a "
                     "contradiction that is not negative");
  }
  return {};
}

Result<std::vector<double>> EdgeContradictions(
    const TranslationProblem& problem, const OneDSfmOptions& options,
    const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(ValidateProblem(problem));
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::vector<double> mean(problem.edges.size(), 0.0);
  if (problem.edges.empty()) return mean;
  const auto count = static_cast<std::size_t>(options.num_projections);
  std::vector<std::vector<double>> broken(count);
  const Status status =
      ParallelFor(context, "1DSfM", count, [&](std::size_t n) {
        broken[n] = BrokenWeights(problem, DrawAxis(problem, context.seed, n));
      });
  if (!status) return tl::unexpected<Error>(status.error());
  for (const std::vector<double>& each : broken) {
    for (std::size_t e = 0; e < mean.size(); ++e) {
      mean[e] += each[e] / static_cast<double>(count);
    }
  }
  // Next to false cycles the greedy order may break what is on none.
  for (const std::size_t e : EdgesOnNoCycle(problem)) mean[e] = 0;
  return mean;
}

TranslationProblem WithoutEdges(const TranslationProblem& problem,
                                const std::vector<bool>& is_excluded) {
  TranslationProblem kept = problem;
  kept.edges.clear();
  kept.ratios.clear();
  std::vector<std::size_t> new_index(problem.edges.size(), 0);
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    if (is_excluded[e]) continue;
    new_index[e] = kept.edges.size();
    kept.edges.push_back(problem.edges[e]);
  }
  for (RatioMeasurement ratio : problem.ratios) {
    if (is_excluded[ratio.reference] || is_excluded[ratio.target]) continue;
    ratio.reference = new_index[ratio.reference];
    ratio.target = new_index[ratio.target];
    kept.ratios.push_back(ratio);
  }
  return kept;
}

Result<TranslationSolution> OneDSfmAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  const auto contradictions = EdgeContradictions(problem, options_, context);
  if (!contradictions) return tl::unexpected<Error>(contradictions.error());
  std::vector<bool> is_excluded;
  for (const double contradiction : *contradictions) {
    is_excluded.push_back(contradiction > options_.max_contradiction);
  }
  const auto num_excluded =
      std::count(is_excluded.begin(), is_excluded.end(), true);
  context.Log(LogLevel::kInfo,
              "1DSfM leaves out " + std::to_string(num_excluded) + " of " +
                  std::to_string(problem.edges.size()) + " relative poses");
  return inner_->Solve(WithoutEdges(problem, is_excluded), context);
}

}  // namespace lowlap
