#include "lowlap/averaging/strategies/internal/bounded_lengths.h"

#include <algorithm>
#include <cmath>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/strategies/internal/direction_system.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

constexpr double kLeastLength = 1.0;
constexpr double kDecrease = 1e-13;
// Of the mean diagonal: fixes the scale where no length is at its bound.
constexpr double kDamping = 1e-11;

Vec3 Offset(const DirectionEdge& edge, const std::vector<Vec3>& centers) {
  return centers[edge.second] - centers[edge.first];
}

// phi and phi' / r at the squared residual.
double DirectionLoss(double squared, double width) {
  if (std::isinf(width)) return 0.5 * squared;
  // width^2 (sqrt(1 + x) - 1) without cancellation.
  return squared / (1 + std::sqrt(1 + squared / (width * width)));
}

double DirectionWeight(double squared, double width) {
  if (std::isinf(width)) return 1;
  return 1 / std::sqrt(1 + squared / (width * width));
}

// C_second - C_first - s d at the best s.
Vec3 DirectionResidual(const DirectionEdge& edge, const Vec3& offset) {
  const double length =
      std::max(kLeastLength, edge.direction_in_world.dot(offset));
  return offset - length * edge.direction_in_world;
}

// Every length at its bound.
Result<std::vector<Vec3>> UnitLengths(const DirectionPart& part,
                                      DirectionSystem* system) {
  std::vector<Vec3> forces(part.views.size(), Vec3::Zero());
  for (const DirectionEdge& edge : part.edges) {
    forces[edge.second] += edge.direction_in_world;
    forces[edge.first] -= edge.direction_in_world;
  }
  const std::vector<Mat3> weights(part.edges.size(), Mat3::Identity());
  LOWLAP_RETURN_IF_ERROR(system->Factor(weights, 0));
  return system->Solve(forces);
}

// From `centers`, or from lengths of one if there are none. Returns the
// iterations.
Result<int> MinimiseBounded(const DirectionPart& part, double width,
                            int max_iterations, const RunContext& context,
                            std::vector<Vec3>* centers) {
  DirectionSystem system(part);
  if (centers->empty()) {
    LOWLAP_ASSIGN_OR_RETURN(*centers, UnitLengths(part, &system));
  }
  double cost = BoundedObjective(part, width, *centers);
  std::vector<Mat3> weights(part.edges.size());
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, iteration - 1, max_iterations));
    std::vector<Vec3> forces(part.views.size(), Vec3::Zero());
    for (std::size_t e = 0; e < part.edges.size(); ++e) {
      const DirectionEdge& edge = part.edges[e];
      const Vec3& d = edge.direction_in_world;
      const Vec3 offset = Offset(edge, *centers);
      const Vec3 residual = DirectionResidual(edge, offset);
      const double weight = DirectionWeight(residual.squaredNorm(), width);
      weights[e] = weight * Mat3::Identity();
      if (d.dot(offset) > kLeastLength) {
        weights[e] -= weight * d * d.transpose();
      }
      forces[edge.second] -= weight * residual;
      forces[edge.first] += weight * residual;
    }
    LOWLAP_RETURN_IF_ERROR(system.Factor(weights, kDamping));
    LOWLAP_ASSIGN_OR_RETURN(const auto step, system.Solve(forces));
    // Armijo: the step descends, since the system is positive definite.
    double slope = 0;
    for (std::size_t v = 1; v < forces.size(); ++v) {
      slope -= forces[v].dot(step[v]);
    }
    std::vector<Vec3> moved(centers->size());
    double moved_cost = cost;
    bool is_lower = false;
    for (double part_of_step = 1; part_of_step > 1e-7; part_of_step /= 2) {
      for (std::size_t v = 0; v < moved.size(); ++v) {
        moved[v] = (*centers)[v] + part_of_step * step[v];
      }
      moved_cost = BoundedObjective(part, width, moved);
      is_lower = moved_cost <= cost + 1e-4 * part_of_step * slope;
      if (is_lower) break;
    }
    if (!is_lower) return iteration;
    const double decrease = cost - moved_cost;
    *centers = std::move(moved);
    cost = moved_cost;
    if (decrease <= kDecrease * cost) return iteration;
  }
  return max_iterations;
}

}  // namespace

BoundedLengthsOptions BoundedLengthsOptions::L2Chordal() {
  return {HUGE_VAL, 100};
}
// The width is OpenMVG's default.
BoundedLengthsOptions BoundedLengthsOptions::SoftL1() { return {0.01, 300}; }
BoundedLengthsOptions BoundedLengthsOptions::Lud() { return {1e-6, 300}; }

Status BoundedLengthsOptions::Validate() const {
  if (loss_width > 0 && max_iterations > 0) return {};
  return MakeError(ErrorCode::kInvalidArgument,
                   "the width of the loss and the number of iterations must be "
                   "positive");
}

double BoundedObjective(const DirectionPart& part, double width,
                        const std::vector<Vec3>& centers) {
  double cost = 0;
  for (const DirectionEdge& edge : part.edges) {
    cost += DirectionLoss(
        DirectionResidual(edge, Offset(edge, centers)).squaredNorm(), width);
  }
  return cost;
}

Result<std::vector<Vec3>> SolveBoundedLengths(
    const DirectionPart& part, const BoundedLengthsOptions& options,
    const RunContext& context, int* num_iterations) {
  constexpr int kMaxEarly = 30;
  std::vector<Vec3> centers;
  double current = HUGE_VAL;
  while (true) {
    const bool is_last = current == options.loss_width;
    const auto iterations = MinimiseBounded(
        part, current, is_last ? options.max_iterations : kMaxEarly, context,
        &centers);
    if (!iterations) return tl::unexpected<Error>(iterations.error());
    *num_iterations += *iterations;
    if (is_last) return centers;
    current = std::isinf(current) ? 1.0 : current / 10;
    // Never by rounding twice almost the same.
    if (current < 2 * options.loss_width) current = options.loss_width;
  }
}

}  // namespace lowlap
