#pragma once

#include <Eigen/Core>

namespace lowlap {

/// A Jacobian block of the solver, which is row major.
template <int Rows, int Cols>
Eigen::Map<Eigen::Matrix<double, Rows, Cols, Eigen::RowMajor>> JacobianMap(
    double* block) {
  return Eigen::Map<Eigen::Matrix<double, Rows, Cols, Eigen::RowMajor>>(block);
}

/// The same with a number of columns that is known at run time.
template <int Rows>
Eigen::Map<Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::RowMajor>>
JacobianMap(double* block, int cols) {
  return Eigen::Map<
      Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::RowMajor>>(block, Rows,
                                                                    cols);
}

}  // namespace lowlap
