#pragma once

#include <Eigen/Core>
#include <Eigen/Sparse>
#include <vector>

#include "lowlap/adjustment/internal/rounds/problem_builder.h"

namespace lowlap {

/// The problem at its present values to first order: the weighted and
/// robustified residuals r and their Jacobian J, so that the noise levels are
/// in both and J^T r is the gradient of the cost. The columns are the tangent
/// spaces of the blocks that are not constant, the landmarks that the Schur
/// complement eliminates first.
struct LinearisedProblem {
  using SparseMat = Eigen::SparseMatrix<double>;

  std::vector<double*> blocks;
  std::vector<int> start;  // first column of every block
  std::size_t eliminated_count = 0;
  int eliminated_size = 0;
  SparseMat jacobian;
  Eigen::VectorXd residuals;

  explicit LinearisedProblem(ProblemBuilder* builder);

  int KeptSize() const {
    return static_cast<int>(jacobian.cols()) - eliminated_size;
  }
  /// First column of a kept block among the kept ones; -1 if it is none.
  int KeptColumn(const double* block) const;

  /// The inverse of the landmarks' own part of H = J^T J (the pseudo-inverse of
  /// those that are underdetermined), which is block diagonal.
  SparseMat InverseOfEliminated(const SparseMat& hessian) const;
  /// S = H_cc - H_cl H_ll^-1 H_lc of the kept columns c.
  SparseMat SchurComplement(const SparseMat& hessian,
                            const SparseMat& inverse_of_eliminated) const;
};

/// Of a symmetric positive semidefinite matrix.
Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& matrix);

}  // namespace lowlap
