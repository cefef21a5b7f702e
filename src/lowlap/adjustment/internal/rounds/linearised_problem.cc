#include "lowlap/adjustment/internal/rounds/linearised_problem.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace lowlap {

Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double floor = 1e-14 * std::max(0.0, values.maxCoeff());
  const Eigen::VectorXd inverse = values.unaryExpr(
      [&](double value) { return value > floor ? 1 / value : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() *
         eigen.eigenvectors().transpose();
}

LinearisedProblem::LinearisedProblem(ProblemBuilder* builder) {
  ceres::Problem& problem = builder->problem();
  const auto ordering = builder->Ordering();
  std::vector<double*> all;
  problem.GetParameterBlocks(&all);
  int column = 0;
  for (const int group : {0, 1}) {
    for (double* block : all) {
      if (ordering->GroupId(block) != group ||
          problem.IsParameterBlockConstant(block)) {
        continue;
      }
      blocks.push_back(block);
      start.push_back(column);
      column += problem.ParameterBlockTangentSize(block);
    }
    if (group == 0) {
      eliminated_count = blocks.size();
      eliminated_size = column;
    }
  }
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  ceres::CRSMatrix crs;
  std::vector<double> values;
  problem.Evaluate(options, nullptr, &values, nullptr, &crs);
  jacobian = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      crs.num_rows, crs.num_cols, static_cast<int>(crs.values.size()),
      crs.rows.data(), crs.cols.data(), crs.values.data());
  residuals = Eigen::Map<const Eigen::VectorXd>(
      values.data(), static_cast<Eigen::Index>(values.size()));
}

int LinearisedProblem::KeptColumn(const double* block) const {
  for (std::size_t n = eliminated_count; n < blocks.size(); ++n) {
    if (blocks[n] == block) return start[n] - eliminated_size;
  }
  return -1;
}

LinearisedProblem::SparseMat LinearisedProblem::InverseOfEliminated(
    const SparseMat& hessian) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t n = 0; n < eliminated_count; ++n) {
    const int at = start[n];
    const int end =
        n + 1 < start.size() ? start[n + 1] : static_cast<int>(jacobian.cols());
    const int size = end - at;
    const Eigen::MatrixXd inverse =
        PseudoInverse(Eigen::MatrixXd(hessian.block(at, at, size, size)));
    for (int row = 0; row < size; ++row) {
      for (int col = 0; col < size; ++col) {
        entries.emplace_back(at + row, at + col, inverse(row, col));
      }
    }
  }
  SparseMat result(eliminated_size, eliminated_size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

LinearisedProblem::SparseMat LinearisedProblem::SchurComplement(
    const SparseMat& hessian, const SparseMat& inverse_of_eliminated) const {
  const int first = eliminated_size, rest = KeptSize();
  const SparseMat cross = hessian.block(0, first, first, rest);
  const SparseMat explained = cross.transpose() * inverse_of_eliminated * cross;
  return SparseMat(hessian.block(first, first, rest, rest)) - explained;
}

}  // namespace lowlap
