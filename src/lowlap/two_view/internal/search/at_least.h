#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace lowlap {

/// L^-1 A L^-T for symmetric A: A in units of L L^T.
template <class Mat>
Mat InUnitsOf(const Eigen::LLT<Mat>& root, const Mat& a) {
  Mat half = a;
  root.matrixL().solveInPlace(half);
  Mat full = half.transpose();
  root.matrixL().solveInPlace(full);
  return 0.5 * (full + full.transpose());
}

/// A with its eigenvalues in units of L L^T raised to `least`.
template <class Mat>
Mat AtLeast(const Eigen::LLT<Mat>& root, const Mat& a, double least) {
  const Eigen::SelfAdjointEigenSolver<Mat> eigen(InUnitsOf(root, a));
  const Mat basis = Mat(root.matrixL()) * eigen.eigenvectors();
  return basis * eigen.eigenvalues().cwiseMax(least).asDiagonal() *
         basis.transpose();
}

}  // namespace lowlap
