#include "lowlap/averaging/strategies/internal/revised_bata.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/strategies/internal/bata.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"
#include "lowlap/core/internal/propagate.h"

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

class AskingCallback final : public ceres::IterationCallback {
 public:
  AskingCallback(const RunContext& context, int max_iterations)
      : context_(context), max_iterations_(max_iterations) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& summary) override {
    status_ = AskToGoOn(context_, summary.iteration, max_iterations_);
    return status_ ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }
  const Status& status() const { return status_; }

 private:
  const RunContext& context_;
  int max_iterations_;
  Status status_;
};

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
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-10;
  solver.num_threads = 1;  // the same for any number of threads
  solver.logging_type = ceres::SILENT;
  AskingCallback asking(context, options.max_iterations);
  solver.callbacks.push_back(&asking);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  LOWLAP_RETURN_IF_ERROR(asking.status());
  if (!summary.IsSolutionUsable()) {
    return MakeError(ErrorCode::kNumerical, summary.message, {}, "averaging");
  }
  *num_iterations += std::max(
      0, static_cast<int>(summary.iterations.size()) - 1);  // but the start
  FixScale(part, &*centers);
  return centers;
}

}  // namespace lowlap
