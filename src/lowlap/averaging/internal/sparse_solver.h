#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// A x = b for symmetric positive definite, sparse A, again and again with the
/// same pattern: the ordering and the symbolic factorisation are kept while the
/// pattern stays.
///
/// Small systems: Eigen's simplicial LDL^T. Large ones: CHOLMOD (Chen et al.,
/// ACM TOMS 35(3), 2008), which goes over to dense supernodes where the factor
/// fills up. Ordered by AMD in both cases, and so the same on every run. Where
/// the symbolic factorisation foretells more than 2e9 operations (graphs that
/// join any view with any other, whose factors fill up in any order, and which
/// are well conditioned): conjugate gradients with the diagonal as
/// preconditioner, from the last solution where it is nearer than 0, to a
/// relative residual of 1e-6. After 3000 steps a residual of 0.1 will do. On
/// one thread, and so the same for any number of them.
class SparseSolver {
 public:
  /// Conjugate gradients ask the host of `context` whether to go on.
  explicit SparseSolver(const RunContext& context = {});
  ~SparseSolver();
  SparseSolver(const SparseSolver&) = delete;
  SparseSolver& operator=(const SparseSolver&) = delete;

  /// `lower` holds the lower triangle of A; what is above it is ignored.
  /// kNumerical if A is singular or the result is not finite (that A is
  /// positive definite is taken for granted); kCancelled.
  Result<Eigen::MatrixXd> Solve(const Eigen::SparseMatrix<double>& lower,
                                const Eigen::MatrixXd& rhs);

  /// The same in two steps, for many right hand sides of one A. Solve may
  /// follow a Factorize that succeeded as often as one likes.
  Status Factorize(const Eigen::SparseMatrix<double>& lower);
  Result<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& rhs);

 private:
  struct Factorisation;
  std::unique_ptr<Factorisation> factorisation_;
};

}  // namespace lowlap
