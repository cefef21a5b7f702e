#pragma once

#include <ceres/manifold.h>

#include <Eigen/Dense>

namespace lowlap {

/// Parameters that move along the columns of a basis B (n x k, full rank) only:
///   x plus d = x + B d.
class SubspaceManifold final : public ceres::Manifold {
 public:
  explicit SubspaceManifold(const Eigen::MatrixXd& basis)
      : basis_(basis),
        inverse_((basis.transpose() * basis).inverse() * basis.transpose()) {}

  int AmbientSize() const override { return static_cast<int>(basis_.rows()); }
  int TangentSize() const override { return static_cast<int>(basis_.cols()); }

  bool Plus(const double* x, const double* delta,
            double* x_plus_delta) const override {
    Ambient(x_plus_delta) =
        Const(x, AmbientSize()) + basis_ * Const(delta, TangentSize());
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, basis_.rows(), basis_.cols()) = basis_;
    return true;
  }
  bool Minus(const double* y, const double* x,
             double* y_minus_x) const override {
    Eigen::Map<Eigen::VectorXd>(y_minus_x, TangentSize()) =
        inverse_ * (Const(y, AmbientSize()) - Const(x, AmbientSize()));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, inverse_.rows(), inverse_.cols()) = inverse_;
    return true;
  }

 private:
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  static Eigen::Map<const Eigen::VectorXd> Const(const double* x, int size) {
    return {x, size};
  }
  Eigen::Map<Eigen::VectorXd> Ambient(double* x) const {
    return {x, AmbientSize()};
  }

  Eigen::MatrixXd basis_;
  Eigen::MatrixXd inverse_;
};

}  // namespace lowlap
