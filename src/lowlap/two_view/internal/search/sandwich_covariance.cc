#include "lowlap/two_view/internal/search/sandwich_covariance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/two_view/internal/search/at_least.h"

namespace lowlap {
namespace {

constexpr double kLeastCurvature = 0.1;
/// A cell to which the fit owes more than all but this share of what it knows
/// counts as if it were that.
constexpr double kLeastRest = 1e-3;

}  // namespace

template <int D>
double SandwichCovariance<D>::PsiVariance() const {
  // Exact data have no scatter; rounding takes its place.
  return std::max(sum_squared_psi_, 1e-24 * num_residuals_) /
         (num_residuals_ - D);
}

template <int D>
typename SandwichCovariance<D>::Mat SandwichCovariance<D>::ScatterOfCells(
    const Eigen::LLT<Mat>& root) const {
  const Mat lower = root.matrixL();
  Mat scatter = Mat::Zero();
  for (const double shift_x : {0.0, 0.5}) {
    for (const double shift_y : {0.0, 0.5}) {
      std::map<std::pair<double, double>, Match> cells;
      for (const Match& match : matches_) {
        const std::pair<double, double> key(
            std::floor(match.place.x() / cell_ + shift_x),
            std::floor(match.place.y() / cell_ + shift_y));
        const auto [cell, is_new] = cells.emplace(key, match);
        if (is_new) continue;
        cell->second.gradient += match.gradient;
        cell->second.information += match.information;
      }
      for (const auto& [key, cell] : cells) {
        // (1 - S)^-1/2 g in units of the information, S the cell's share.
        const Eigen::SelfAdjointEigenSolver<Mat> share(
            InUnitsOf(root, cell.information));
        Vec gradient = cell.gradient;
        root.matrixL().solveInPlace(gradient);
        const Vec rest =
            (1 - share.eigenvalues().array()).max(kLeastRest).matrix();
        gradient = share.eigenvectors().transpose() * gradient;
        gradient = gradient.cwiseQuotient(rest.cwiseSqrt());
        gradient = lower * (share.eigenvectors() * gradient);
        scatter += 0.25 * gradient * gradient.transpose();
      }
    }
  }
  return scatter;
}

template <int D>
std::optional<typename SandwichCovariance<D>::Mat>
SandwichCovariance<D>::Solve() const {
  const double slope = sum_slope_ / std::max(num_residuals_, 1);
  if (num_residuals_ <= D || !(slope > 0)) return std::nullopt;
  if (!IsWellDetermined(Eigen::LDLT<Mat>(information_))) return std::nullopt;
  const Eigen::LLT<Mat> root(information_);
  if (root.info() != Eigen::Success) return std::nullopt;
  const double variance = PsiVariance();
  const Mat hessian =
      AtLeast(root, hessian_, kLeastCurvature * slope) + prior_hessian_;
  Mat scatter = variance * information_;
  if (cell_ > 0) scatter = AtLeast(root, ScatterOfCells(root), variance);
  scatter += prior_scatter_;
  const Eigen::LDLT<Mat> factor(hessian);
  if (!IsWellDetermined(factor)) return std::nullopt;
  const Mat half = factor.solve(scatter);
  const Mat covariance = factor.solve(Mat(half.transpose()));
  if (!covariance.allFinite()) return std::nullopt;
  return Mat(0.5 * (covariance + covariance.transpose()));
}

template class SandwichCovariance<5>;
template class SandwichCovariance<8>;

}  // namespace lowlap
