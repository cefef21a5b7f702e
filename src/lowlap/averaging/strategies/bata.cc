#include "lowlap/averaging/strategies/internal/bata.h"

#include <Eigen/Core>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/internal/difference_solver.h"
#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/robust/internal/robust_loss.h"

namespace lowlap {
namespace {

// d . offset / |offset|^2, the best inverse length; 0 if they point apart.
double InverseLength(const DirectionEdge& edge, const Vec3& offset) {
  const double along = edge.direction_in_world.dot(offset);
  return along > 0 ? along / offset.squaredNorm() : 0.0;
}

}  // namespace

Status BataOptions::Validate() const {
  if (rounds > 0 && steps_per_round > 0) return {};
  return MakeError(ErrorCode::kInvalidArgument,
                   "the numbers of rounds and of steps must be positive");
}

Result<std::vector<Vec3>> SolveBata(const DirectionPart& part,
                                    const BataOptions& options,
                                    const RunContext& context,
                                    int* num_iterations) {
  // Of the mean weight: holds edges of inverse length 0 where they are, so that
  // no view comes loose.
  constexpr double kHold = 1e-9;
  LOWLAP_ASSIGN_OR_RETURN(std::vector<Vec3> centers,
                          SolveRevisedLud(part, {}, context, num_iterations));

  const auto num_edges = static_cast<Eigen::Index>(part.edges.size());
  std::vector<DifferenceEdge> differences;
  for (const DirectionEdge& edge : part.edges) {
    differences.push_back({edge.first, edge.second});
  }
  Eigen::VectorXd robust(num_edges), weights(num_edges);
  Eigen::MatrixXd measured(num_edges, 3);
  SparseSolver solver(context);
  for (int round = 0; round < options.rounds; ++round) {
    for (Eigen::Index e = 0; e < num_edges; ++e) {
      const DirectionEdge& edge = part.edges[static_cast<std::size_t>(e)];
      const Vec3 offset = centers[edge.second] - centers[edge.first];
      const double inverse = InverseLength(edge, offset);
      robust(e) = HuberWeight(
          (inverse * offset - edge.direction_in_world).norm(), kAngleHuber);
    }
    for (int step = 0; step < options.steps_per_round; ++step) {
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, round, options.rounds));
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
      LOWLAP_ASSIGN_OR_RETURN(const auto moved,
                              SolveDifferences(part.views.size(), differences,
                                               weights, measured, &solver));
      for (std::size_t v = 0; v < centers.size(); ++v) {
        centers[v] = moved.row(static_cast<Eigen::Index>(v)).transpose();
      }
      ++*num_iterations;
    }
  }
  return centers;
}

}  // namespace lowlap
