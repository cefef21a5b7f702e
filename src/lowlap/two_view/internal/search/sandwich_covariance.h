#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <optional>
#include <vector>

namespace lowlap {

/// Whether a decomposed Hessian or information has full rank.
template <class Matrix>
bool IsWellDetermined(const Eigen::LDLT<Matrix>& factor) {
  return factor.info() == Eigen::Success &&
         factor.vectorD().minCoeff() > 1e-14 * factor.vectorD().maxCoeff();
}

/// The covariance of D parameters that minimise a robust loss of residuals,
///   H^-1 M H^-1,  H = sum d^2 rho,  M = covariance of sum d rho
/// (Huber, "Robust Statistics", section 6.3), where neighbours err together:
/// what is seen of one surface shares its light, blur and slant, and hundreds
/// of its points do not average that out. M is the sum over cells of the image
/// of (sum of the cell's gradients) squared (Liang, Zeger, "Longitudinal data
/// analysis using generalized linear models", Biometrika 1986), each enlarged
/// by what the fit has taken of it (Bell, McCaffrey, "Bias reduction in
/// standard errors", Survey Methodology 2002), as the mean of four grids, half
/// a cell apart.
///
/// H is that of each residual at its place in the loss, not the mean: where few
/// residuals, and large ones, decide a direction, the loss is much flatter
/// there than their number says. Neither is trusted beyond reason: H is at
/// least a tenth of what the mean gives, M at least what independent errors
/// give.
template <int D>
class SandwichCovariance {
 public:
  using Vec = Eigen::Matrix<double, D, 1>;
  using Mat = Eigen::Matrix<double, D, D>;

  /// `cell` is the side of the cells; 0: errors are independent.
  explicit SandwichCovariance(double cell) : cell_(cell) {}

  /// A match at a place of the image, with a residual of R components:
  /// jacobian J, gradient psi (R) and Hessian S (R x R) of its loss.
  template <int R>
  void Add(const Eigen::Vector2d& place,
           const Eigen::Matrix<double, R, D>& jacobian,
           const Eigen::Matrix<double, R, 1>& psi,
           const Eigen::Matrix<double, R, R>& slope) {
    matches_.push_back(
        {place, jacobian.transpose() * psi, jacobian.transpose() * jacobian});
    information_ += matches_.back().information;
    hessian_ += jacobian.transpose() * slope * jacobian;
    sum_squared_psi_ += psi.squaredNorm();
    sum_slope_ += slope.trace();
    num_residuals_ += R;
  }

  /// What does not depend on matches, with Hessian and covariance of gradient.
  void AddPrior(const Mat& hessian, const Mat& gradient_covariance) {
    prior_hessian_ += hessian;
    prior_scatter_ += gradient_covariance;
  }

  /// nullopt: no more residuals than parameters, or a singular system.
  std::optional<Mat> Solve() const;

 private:
  struct Match {
    Eigen::Vector2d place;
    Vec gradient;
    Mat information;
  };
  double PsiVariance() const;
  Mat ScatterOfCells(const Eigen::LLT<Mat>& root) const;

  double cell_;
  std::vector<Match> matches_;
  Mat information_ = Mat::Zero();
  Mat hessian_ = Mat::Zero();
  Mat prior_hessian_ = Mat::Zero();
  Mat prior_scatter_ = Mat::Zero();
  double sum_squared_psi_ = 0;
  double sum_slope_ = 0;
  int num_residuals_ = 0;
};

extern template class SandwichCovariance<5>;
extern template class SandwichCovariance<8>;

}  // namespace lowlap
