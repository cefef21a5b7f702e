#include "lowlap/adjustment/internal/rounds/solve.h"

#include <ceres/solver.h>

#include <algorithm>

#include "lowlap/adjustment/internal/rounds/problem_builder.h"
#include "lowlap/adjustment/internal/rounds/quiet_logging.h"

namespace lowlap {
namespace {

class ProgressCallback final : public ceres::IterationCallback {
 public:
  ProgressCallback(const RunContext& context, const std::string& stage,
                   int max_iterations)
      : context_(context), stage_(stage), max_iterations_(max_iterations) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& summary) override {
    cancelled_ = !context_.Progress(
        "adjustment: " + stage_,
        static_cast<std::size_t>(std::max(0, summary.iteration)),
        static_cast<std::size_t>(max_iterations_));
    return cancelled_ ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }
  bool cancelled() const { return cancelled_; }

 private:
  const RunContext& context_;
  std::string stage_;
  int max_iterations_;
  bool cancelled_ = false;
};

ceres::Solver::Options SolverOptions(const AdjustmentOptions& options,
                                     const SolveRequest& request,
                                     ProblemBuilder* builder) {
  ceres::Solver::Options solver;
  solver.linear_solver_ordering =
      std::make_shared<ceres::ParameterBlockOrdering>();
  for (double* block : builder->eliminated()) {
    solver.linear_solver_ordering->AddElementToGroup(block, 0);
  }
  int reduced_size = 0;
  for (double* block : builder->kept()) {
    solver.linear_solver_ordering->AddElementToGroup(block, 1);
    reduced_size += builder->problem().ParameterBlockTangentSize(block);
  }
  // The dense reduced system of fifty cameras factorises in a millisecond.
  constexpr int kMaxDenseSize = 300;
  solver.linear_solver_type =
      reduced_size <= kMaxDenseSize ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = request.function_tolerance;
  solver.parameter_tolerance = 1e-10;
  solver.gradient_tolerance = 1e-14;
  // In a valley the reduced system can be factorised again only when the region
  // is far smaller.
  solver.max_num_consecutive_invalid_steps = 20;
  // More threads would add up the reduced system in an order of chance.
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  return solver;
}

}  // namespace

Result<SolveOutcome> SolveOnce(const AdjustmentOptions& options,
                               const SolveRequest& request,
                               const RunContext& context, CameraSet* cameras,
                               StructureState* state) {
  const ProblemSelection selection = SelectForSolve(*cameras, *state, options);
  if (selection.IsEmpty()) {
    return MakeError(
        ErrorCode::kInsufficientData,
        cameras->views.empty()
            ? "nothing to adjust: no view has both a pose and an intrinsic"
            : "nothing to adjust: no point in two posed views, no line in "
              "three, and no coplanar pair");
  }
  const std::vector<Component> components =
      FindComponents(*cameras, *state, selection);
  const std::vector<PoseState> references =
      EnterComponentFrames(components, cameras, state);

  const QuietLogging quiet;
  ProblemBuilder builder(options, request, selection, components, cameras,
                         state);
  ceres::Solver::Options solver_options =
      SolverOptions(options, request, &builder);
  ProgressCallback progress(context, request.stage, options.max_iterations);
  solver_options.callbacks.push_back(&progress);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options, &builder.problem(), &summary);
  if (progress.cancelled()) {
    return MakeError(ErrorCode::kCancelled, "stopped on request", {},
                     "adjustment: " + request.stage);
  }
  builder.TakeResults();
  if (!summary.IsSolutionUsable() || !builder.AllFinite()) {
    return MakeError(ErrorCode::kNumerical,
                     "the adjustment failed: " + summary.message, {},
                     request.stage);
  }

  SolveOutcome outcome;
  LeaveComponentFrames(components, references, cameras, state);
  outcome.components = components.size();
  outcome.pose_observed.assign(cameras->poses.size(), 0);
  for (const Component& component : components) {
    for (const int pose : component.poses) outcome.pose_observed[pose] = 1;
  }
  SolveReport& report = outcome.report;
  report.stage = request.stage;
  report.residuals = static_cast<std::size_t>(summary.num_residuals_reduced);
  report.parameters =
      static_cast<std::size_t>(summary.num_effective_parameters_reduced);
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.iterations =
      std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  report.converged = summary.termination_type == ceres::CONVERGENCE;
  report.seconds = summary.total_time_in_seconds;
  return outcome;
}

}  // namespace lowlap
