#include "lowlap/averaging/strategies/internal/revised_bata.h"

#include <algorithm>
#include <cmath>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/strategies/internal/bata.h"
#include "lowlap/averaging/strategies/internal/direction_system.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/robust/internal/robust_loss.h"

namespace lowlap {
namespace {

// Weighted Gauss-Newton terms of one edge with its inverse length eliminated:
//   e = d - (u . d) u,   u = offset / |offset|,
//   de = -(u d^T + (u . d) I) (I - u u^T) / |offset|  d offset.
struct EdgeTerms {
  Mat3 hessian = Mat3::Zero();
  Vec3 gradient = Vec3::Zero();
};

EdgeTerms Linearise(const DirectionEdge& edge, const Vec3& offset) {
  EdgeTerms terms;
  const Vec3& d = edge.direction_in_world;
  const double length = offset.norm();
  // Beyond a right angle the objective is flat.
  if (!(d.dot(offset) > 0)) return terms;
  const Vec3 u = offset / length;
  const Vec3 error = d - u.dot(d) * u;
  const Mat3 jacobian = -(u * d.transpose() + u.dot(d) * Mat3::Identity()) *
                        (Mat3::Identity() - u * u.transpose()) / length;
  const double weight = HuberWeight(error.norm(), kAngleHuber);
  terms.hessian = weight * jacobian.transpose() * jacobian;
  terms.gradient = weight * jacobian.transpose() * error;
  return terms;
}

// The mean length is 1: the objective does not fix it.
void FixScale(const DirectionPart& part, std::vector<Vec3>* centers) {
  double total = 0;
  for (const DirectionEdge& edge : part.edges) {
    total += ((*centers)[edge.second] - (*centers)[edge.first]).norm();
  }
  if (!(total > 0)) return;
  const double scale = static_cast<double>(part.edges.size()) / total;
  for (Vec3& center : *centers) center *= scale;
}

}  // namespace

Result<std::vector<Vec3>> SolveRevisedBata(const DirectionPart& part,
                                           const RevisedBataOptions& options,
                                           const RunContext& context,
                                           int* num_iterations) {
  constexpr double kDecrease = 1e-10;
  constexpr double kLeastDamping = 1e-9;
  constexpr double kMostDamping = 1e6;
  LOWLAP_ASSIGN_OR_RETURN(std::vector<Vec3> centers,
                          SolveRevisedLud(part, {}, context, num_iterations));
  FixScale(part, &centers);
  DirectionSystem system(part);
  double cost = AngleObjective(part, centers);
  double damping = 1e-4;
  std::vector<Mat3> hessians(part.edges.size());
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    ++*num_iterations;
    std::vector<Vec3> forces(part.views.size(), Vec3::Zero());
    for (std::size_t e = 0; e < part.edges.size(); ++e) {
      const DirectionEdge& edge = part.edges[e];
      const EdgeTerms terms =
          Linearise(edge, centers[edge.second] - centers[edge.first]);
      hessians[e] = terms.hessian;
      forces[edge.second] -= terms.gradient;
      forces[edge.first] += terms.gradient;
    }
    bool is_lower = false;
    double decrease = 0;
    while (!is_lower && damping <= kMostDamping) {
      LOWLAP_RETURN_IF_ERROR(
          AskToGoOn(context, iteration, options.max_iterations));
      LOWLAP_RETURN_IF_ERROR(system.Factor(hessians, damping));
      LOWLAP_ASSIGN_OR_RETURN(const auto step, system.Solve(forces));
      std::vector<Vec3> moved(centers.size());
      for (std::size_t v = 0; v < moved.size(); ++v) {
        moved[v] = centers[v] + step[v];
      }
      const double moved_cost = AngleObjective(part, moved);
      is_lower = moved_cost < cost;
      if (is_lower) {
        decrease = cost - moved_cost;
        cost = moved_cost;
        centers = std::move(moved);
        damping = std::max(damping / 10, kLeastDamping);
      } else {
        damping *= 10;
      }
    }
    if (!is_lower) break;
    FixScale(part, &centers);
    if (decrease <= kDecrease * cost) break;
  }
  return centers;
}

}  // namespace lowlap
