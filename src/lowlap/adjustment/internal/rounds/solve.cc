#include "lowlap/adjustment/internal/rounds/solve.h"

#include <ceres/solver.h>

#include <algorithm>

#include "lowlap/adjustment/internal/rounds/linearised_problem.h"
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
  // The dense reduced system of a hundred cameras factorises in milliseconds.
  constexpr int kMaxDenseSize = 600;
  solver.linear_solver_type =
      reduced_size <= kMaxDenseSize ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = request.function_tolerance;
  solver.parameter_tolerance = 1e-10;
  solver.gradient_tolerance = 1e-14;
  // More threads would add up the reduced system in an order of chance.
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  return solver;
}

// From the tangent space of the block to its three numbers.
Eigen::MatrixXd TangentToAmbient(const ceres::Problem& problem, double* block) {
  const ceres::Manifold* manifold = problem.GetManifold(block);
  if (manifold == nullptr) return Mat3::Identity();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      jacobian(3, manifold->TangentSize());
  manifold->PlusJacobian(block, jacobian.data());
  return jacobian;
}

// Covariances of the camera centres in world units, from the Hessian J^T J of
// the problem at its present values with points and lines marginalised:
//   S = H_cc - H_cl H_ll^-1 H_lc,  cov = S^-1
// (the pseudo-inverse, should a camera be underdetermined). J is that of the
// weighted and robustified residuals, so that the noise levels are in it. The
// components are in their frames; `saved_references` are the reference poses in
// world, which are absent from the result.
std::map<PoseId, Mat3> CenterCovariances(
    const std::vector<Component>& components,
    const std::vector<PoseState>& saved_references, const CameraSet& cameras,
    ProblemBuilder* builder) {
  const ceres::Problem& problem = builder->problem();
  const LinearisedProblem linearised(builder);
  if (linearised.kept_size == 0) return {};
  const Eigen::MatrixXd covariance =
      PseudoInverse(Eigen::MatrixXd(linearised.schur_complement));
  std::map<PoseId, Mat3> result;
  for (std::size_t n = 0; n < components.size(); ++n) {
    const Component& component = components[n];
    const Mat3 world_from_frame =
        saved_references[n].cam_from_world.toRotationMatrix().transpose();
    for (const int pose : component.poses) {
      double* center = builder->CenterBlock(pose);
      const int column = linearised.KeptColumn(center);
      if (column < 0) continue;
      const int size = problem.ParameterBlockTangentSize(center);
      const Eigen::MatrixXd to_world = component.Unit() * world_from_frame *
                                       TangentToAmbient(problem, center);
      result[cameras.poses[pose].id] =
          to_world * covariance.block(column, column, size, size) *
          to_world.transpose();
    }
  }
  return result;
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
  std::vector<PoseState> saved(components.size());
  for (std::size_t n = 0; n < components.size(); ++n) {
    EnterComponentFrame(components[n], cameras, state, &saved[n]);
  }

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
  if (request.center_covariances) {
    outcome.center_covariances =
        CenterCovariances(components, saved, *cameras, &builder);
  }
  for (std::size_t n = 0; n < components.size(); ++n) {
    LeaveComponentFrame(components[n], saved[n], cameras, state);
  }
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
