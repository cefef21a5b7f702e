#include "lowlap/averaging/strategies/internal/revised_bata.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>

#include "lowlap/averaging/strategies/internal/bata.h"
#include "lowlap/averaging/strategies/internal/minimise.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"

namespace lowlap {
namespace {

// d - (u . d) u, u = offset / |offset|: the inverse length is eliminated.
struct AngleError {
  Vec3 direction_in_world;

  template <class T>
  bool operator()(const T* first, const T* second, T* error) const {
    using Vec3Of = Eigen::Matrix<T, 3, 1>;
    const Vec3Of offset =
        Eigen::Map<const Vec3Of>(second) - Eigen::Map<const Vec3Of>(first);
    Eigen::Map<Vec3Of> mapped(error);
    mapped = direction_in_world.cast<T>();
    const T along = mapped.dot(offset);
    // Beyond a right angle the objective is flat.
    if (along > 0.0) mapped -= along / offset.squaredNorm() * offset;
    return true;
  }
};

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
  auto centers = SolveRevisedLud(part, {}, context, num_iterations);
  if (!centers) return centers;
  FixScale(part, &*centers);
  ceres::HuberLoss loss(kAngleHuber);
  ceres::Problem::Options keep;
  keep.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(keep);
  for (const DirectionEdge& edge : part.edges) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<AngleError, 3, 3, 3>(
            new AngleError{edge.direction_in_world}),
        &loss, (*centers)[edge.first].data(), (*centers)[edge.second].data());
  }
  problem.AddParameterBlock(centers->front().data(), 3);
  problem.SetParameterBlockConstant(centers->front().data());
  const auto iterations =
      Minimise(context, options.max_iterations, 1e-10, &problem);
  if (!iterations) return tl::unexpected<Error>(iterations.error());
  *num_iterations += *iterations;
  FixScale(part, &*centers);
  return centers;
}

}  // namespace lowlap
