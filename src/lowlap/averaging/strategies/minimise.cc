#include "lowlap/averaging/strategies/internal/minimise.h"

#include <ceres/solver.h>

#include <algorithm>

#include "lowlap/averaging/internal/cancellation.h"

namespace lowlap {
namespace {

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

Result<int> Minimise(const RunContext& context, int max_iterations,
                     double tolerance, ceres::Problem* problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = tolerance;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  AskingCallback asking(context, max_iterations);
  options.callbacks.push_back(&asking);
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
  if (!asking.status()) return tl::unexpected<Error>(asking.status().error());
  // The first is the start.
  return std::max(0, static_cast<int>(summary.iterations.size()) - 1);
}

}  // namespace lowlap
