#include "lowlap/averaging/strategies/internal/bata.h"

#include <Eigen/Core>

#include "lowlap/averaging/internal/difference_solver.h"
#include "lowlap/averaging/strategies/internal/angle_objective.h"

namespace lowlap {
namespace {

// d . offset / |offset|^2, the best inverse length; 0 if they point apart.
double InverseLength(const DirectionEdge& edge, const Vec3& offset) {
  const double along = edge.direction_in_world.dot(offset);
  return along > 0 ? along / offset.squaredNorm() : 0.0;
}

Result<std::vector<Vec3>> DescendBlocks(const DirectionPart& part,
                                        int* num_iterations) {
  constexpr int kRounds = 10;
  constexpr int kStepsPerRound = 10;
  // Of the mean weight: holds edges of inverse length 0 where they are, so that
  // no view comes loose.
  constexpr double kHold = 1e-9;
  auto start = SolveRevisedLud(part, num_iterations);
  if (!start) return start;
  std::vector<Vec3> centers = std::move(*start);

  const auto num_edges = static_cast<Eigen::Index>(part.edges.size());
  std::vector<DifferenceEdge> differences;
  for (const DirectionEdge& edge : part.edges) {
    differences.push_back({edge.first, edge.second});
  }
  Eigen::VectorXd robust(num_edges), weights(num_edges);
  Eigen::MatrixXd measured(num_edges, 3);
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index e = 0; e < num_edges; ++e) {
      const DirectionEdge& edge = part.edges[static_cast<std::size_t>(e)];
      const Vec3 offset = centers[edge.second] - centers[edge.first];
      const double inverse = InverseLength(edge, offset);
      robust(e) =
          AngleWeight((inverse * offset - edge.direction_in_world).norm());
    }
    for (int step = 0; step < kStepsPerRound; ++step) {
      for (Eigen::Index e = 0; e < num_edges; ++e) {
        const DirectionEdge& edge = part.edges[static_cast<std::size_t>(e)];
        const Vec3 offset = centers[edge.second] - centers[edge.first];
        const double inverse = InverseLength(edge, offset);
        weights(e) = robust(e) * inverse * inverse;
        if (inverse > 0) {
          measured.row(e) = edge.direction_in_world.transpose() / inverse;
        } else {
          measured.row(e) = offset.transpose();
        }
      }
      const double hold = kHold * weights.mean();
      if (!(hold > 0)) {
        return MakeError(ErrorCode::kNumerical,
                         "every direction of a part points backwards");
      }
      weights = weights.cwiseMax(hold);
      const auto moved =
          SolveDifferences(part.views.size(), differences, weights, measured);
      if (!moved) return tl::unexpected<Error>(moved.error());
      for (std::size_t v = 0; v < centers.size(); ++v) {
        centers[v] = moved->row(static_cast<Eigen::Index>(v)).transpose();
      }
      ++*num_iterations;
    }
  }
  return centers;
}

}  // namespace

Result<TranslationSolution> BataAverager::Solve(
    const TranslationProblem& problem, const RunContext&) const {
  return SolveDirectionParts(problem, DescendBlocks);
}

}  // namespace lowlap
