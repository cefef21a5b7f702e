#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "lowlap/adjustment/internal/rounds/problem_builder.h"

namespace lowlap {

using SparseMat = Eigen::SparseMatrix<double>;

/// The problem at its present values to first order, without the landmarks that
/// the Schur complement eliminates. With the weighted and robustified residuals
/// r and their Jacobian J, so that the noise levels are in both and J^T r is
/// the gradient of the cost: H = J^T J, of the landmarks l and of the kept
/// columns c, which are the tangent spaces of the blocks that are not constant.
struct LinearisedProblem {
  /// Kept blocks and their first columns.
  std::vector<const double*> blocks;
  std::vector<int> start;
  int kept_size = 0;

  /// S = H_cc - H_cl H_ll^-1 H_lc, with the pseudo-inverse of landmarks that
  /// are underdetermined.
  SparseMat schur_complement;
  Eigen::VectorXd kept_diagonal;  // of H_cc
  /// What every landmark adds to the gradient of the kept columns once it is
  /// eliminated: J_c^T (r - J_l H_ll^-1 J_l^T r) over its residuals. Residuals
  /// without a landmark add by themselves.
  Eigen::SparseMatrix<double, Eigen::RowMajor> gradients;
  /// Residuals beyond the degrees of freedom of the landmarks.
  int redundancy = 0;

  explicit LinearisedProblem(ProblemBuilder* builder);

  /// First column of a kept block; -1 if it is none.
  int KeptColumn(const double* block) const;
};

/// Of a symmetric positive semidefinite matrix.
Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& matrix);

}  // namespace lowlap
