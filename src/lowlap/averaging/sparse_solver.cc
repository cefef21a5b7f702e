#include "lowlap/averaging/internal/sparse_solver.h"

#include <omp.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

// Below this CHOLMOD's administration costs more than it saves.
constexpr Eigen::Index kLargeSystem = 2000;
constexpr double kMaxOperations = 2e9;
constexpr double kGradientTolerance = 1e-6;
// What is reached after so many steps will do, if it is no worse than this.
constexpr std::size_t kMaxGradientSteps = 3000;
constexpr double kWorstGradientError = 0.1;

class Cholmod : public Eigen::CholmodDecomposition<Matrix, Eigen::Lower> {
 public:
  Cholmod() {
    cholmod().print = 0;  // the library writes to no stream
    cholmod().nmethods = 1;
    cholmod().method[0].ordering = CHOLMOD_AMD;
    cholmod().postorder = 1;
  }
  /// After analyzePattern.
  double Operations() { return cholmod().fl; }
};

// CHOLMOD's parallel regions run on the calling thread while this lives: they
// are many and short, and the caller's threads have work of their own.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) {
    omp_set_max_active_levels(0);
  }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_;
};

// Remembers the pattern of the last matrix.
class Pattern {
 public:
  bool Changed(const Matrix& matrix) {
    const auto* outer = matrix.outerIndexPtr();
    const auto* inner = matrix.innerIndexPtr();
    const bool same =
        outer_.size() == static_cast<std::size_t>(matrix.cols() + 1) &&
        std::equal(outer_.begin(), outer_.end(), outer) &&
        inner_.size() == static_cast<std::size_t>(matrix.nonZeros()) &&
        std::equal(inner_.begin(), inner_.end(), inner);
    if (same) return false;
    outer_.assign(outer, outer + matrix.cols() + 1);
    inner_.assign(inner, inner + matrix.nonZeros());
    return true;
  }

 private:
  std::vector<Matrix::StorageIndex> outer_, inner_;
};

tl::unexpected<Error> Unsolvable(Eigen::Index num_unknowns) {
  return MakeError(ErrorCode::kNumerical, "a sparse system of " +
                                              std::to_string(num_unknowns) +
                                              " unknowns could not be solved");
}

template <class Solver>
Status FactorizeWith(const Matrix& lower, Solver* solver) {
  solver->factorize(lower);
  if (solver->info() == Eigen::Success) return {};
  return Unsolvable(lower.rows());
}

template <class Solver>
Result<Eigen::MatrixXd> SolveWith(const Eigen::MatrixXd& rhs, Solver* solver) {
  Eigen::MatrixXd solution = solver->solve(rhs);
  if (solver->info() == Eigen::Success && solution.allFinite()) return solution;
  return Unsolvable(rhs.rows());
}

// One right hand side, from `x`, preconditioned by the diagonal. Returns the
// relative residual.
Result<double> RunGradients(const Matrix& lower, const Eigen::VectorXd& rhs,
                            const RunContext& context, Eigen::VectorXd* x) {
  constexpr std::size_t kStepsBetweenQuestions = 16;
  const double rhs_norm = rhs.norm();
  if (rhs_norm == 0) {
    x->setZero();
    return 0.0;
  }
  const auto a = lower.selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd diagonal = lower.diagonal();
  Eigen::VectorXd residual = rhs - a * *x;
  Eigen::VectorXd direction = residual.cwiseQuotient(diagonal);
  double product = residual.dot(direction);
  for (std::size_t step = 0; step < kMaxGradientSteps &&
                             residual.norm() > kGradientTolerance * rhs_norm;
       ++step) {
    if (step % kStepsBetweenQuestions == 0) {
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, step, kMaxGradientSteps));
    }
    const Eigen::VectorXd image = a * direction;
    const double length = product / direction.dot(image);
    *x += length * direction;
    residual -= length * image;
    const Eigen::VectorXd preconditioned = residual.cwiseQuotient(diagonal);
    const double last = product;
    product = residual.dot(preconditioned);
    direction = preconditioned + (product / last) * direction;
  }
  return residual.norm() / rhs_norm;
}

// From `guess`, if it is of use.
Result<Eigen::MatrixXd> SolveByGradients(const Matrix& lower,
                                         const Eigen::MatrixXd& rhs,
                                         const Eigen::MatrixXd& guess,
                                         const RunContext& context) {
  Eigen::MatrixXd solution = Eigen::MatrixXd::Zero(rhs.rows(), rhs.cols());
  if (guess.rows() == rhs.rows() && guess.cols() == rhs.cols() &&
      (rhs - lower.selfadjointView<Eigen::Lower>() * guess).norm() <
          rhs.norm()) {
    solution = guess;
  }
  for (Eigen::Index c = 0; c < rhs.cols(); ++c) {
    Eigen::VectorXd column = solution.col(c);
    LOWLAP_ASSIGN_OR_RETURN(const auto error,
                            RunGradients(lower, rhs.col(c), context, &column));
    if (!column.allFinite() || !(error <= kWorstGradientError)) {
      return Unsolvable(lower.rows());
    }
    solution.col(c) = column;
  }
  return solution;
}

}  // namespace

struct SparseSolver::Factorisation {
  RunContext context;
  Pattern pattern;
  Eigen::SimplicialLDLT<Matrix> small;
  std::unique_ptr<Cholmod> large;
  Matrix lower;          // of what conjugate gradients solve
  Eigen::MatrixXd last;  // by conjugate gradients

  bool UsesGradients() const { return large->Operations() > kMaxOperations; }
};

SparseSolver::SparseSolver(const RunContext& context)
    : factorisation_(std::make_unique<Factorisation>()) {
  factorisation_->context = context;
}
SparseSolver::~SparseSolver() = default;

Status SparseSolver::Factorize(const Matrix& lower) {
  Factorisation& f = *factorisation_;
  const bool new_pattern = f.pattern.Changed(lower);
  if (lower.rows() < kLargeSystem) {
    if (new_pattern) f.small.analyzePattern(lower);
    return FactorizeWith(lower, &f.small);
  }
  const OneThread one_thread;
  if (new_pattern) {
    f.large = std::make_unique<Cholmod>();
    f.large->analyzePattern(lower);
    f.last.resize(0, 0);
  }
  if (!f.UsesGradients()) return FactorizeWith(lower, f.large.get());
  f.lower = lower;
  return {};
}

Result<Eigen::MatrixXd> SparseSolver::Solve(const Eigen::MatrixXd& rhs) {
  Factorisation& f = *factorisation_;
  if (rhs.rows() < kLargeSystem) return SolveWith(rhs, &f.small);
  const OneThread one_thread;
  if (!f.UsesGradients()) return SolveWith(rhs, f.large.get());
  auto solution = SolveByGradients(f.lower, rhs, f.last, f.context);
  if (solution) f.last = *solution;
  return solution;
}

Result<Eigen::MatrixXd> SparseSolver::Solve(const Matrix& lower,
                                            const Eigen::MatrixXd& rhs) {
  LOWLAP_RETURN_IF_ERROR(Factorize(lower));
  return Solve(rhs);
}

}  // namespace lowlap
