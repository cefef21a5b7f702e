#include "lowlap/scene/internal/undistort.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lowlap {
namespace {

// c[0] + c[1] s + c[2] s^2 + ...
double Polynomial(const std::vector<double>& c, double s) {
  double value = 0;
  for (auto it = c.rbegin(); it != c.rend(); ++it) value = value * s + *it;
  return value;
}

// The real roots in (0, limit), ascending: between two roots of the derivative
// a polynomial is monotone. Roots of even multiplicity may be missed.
std::vector<double> PositiveRoots(const std::vector<double>& c, double limit) {
  if (c.size() < 2) return {};
  std::vector<double> derivative;
  for (std::size_t n = 1; n < c.size(); ++n) {
    derivative.push_back(static_cast<double>(n) * c[n]);
  }
  std::vector<double> ends = PositiveRoots(derivative, limit);
  ends.push_back(limit);
  std::vector<double> roots;
  double low = 0;
  for (double high : ends) {
    const double end = high;
    const bool rises = Polynomial(c, high) > 0;
    if ((Polynomial(c, low) > 0) != rises) {
      constexpr int kBisections = 100;
      for (int n = 0; n < kBisections; ++n) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        ((Polynomial(c, middle) > 0) == rises ? high : low) = middle;
      }
      roots.push_back(0.5 * (low + high));
    }
    low = end;
  }
  return roots;
}

// p(r) = r (1 + c[0] r^2 + c[1] r^4 + ...) and its inverse on [0, limit].
class OddPolynomial {
 public:
  OddPolynomial(const double* coefficients, int count, double limit)
      : factor_{1}, slope_{1}, limit_(limit) {
    bool may_fold = false;
    for (int n = 0; n < count; ++n) {
      factor_.push_back(coefficients[n]);
      slope_.push_back((2 * n + 3) * coefficients[n]);
      may_fold = may_fold || coefficients[n] < 0;
    }
    if (!may_fold) return;
    const std::vector<double> folds = PositiveRoots(slope_, limit * limit);
    if (!folds.empty()) limit_ = std::sqrt(folds.front());
  }

  double limit() const { return limit_; }
  double Value(double r) const { return r * Polynomial(factor_, r * r); }

  std::optional<double> Solve(double value) const {
    if (!(value >= 0) || value >= Value(limit_)) return std::nullopt;
    double low = 0, high = limit_, r = std::min(value, limit_);
    constexpr int kIterations = 100;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const double error = Value(r) - value;
      (error > 0 ? high : low) = r;
      double next = r - error / Polynomial(slope_, r * r);
      if (!(next >= low && next <= high)) next = 0.5 * (low + high);
      const double step = std::abs(next - r);
      r = next;
      if (step <= 1e-15 * r) break;
    }
    return r;
  }

 private:
  std::vector<double> factor_, slope_;  // in r^2
  double limit_;
};

// Undistorted radii beyond this (89.9 degrees) are no pinhole's.
constexpr double kLargestRadius = 1e3;

Vec2 WithNorm(const Vec2& v, double norm) {
  const double length = v.norm();
  return length > 0 ? Vec2(v * (norm / length)) : v;
}

// d Distort / d p of Brown's model.
Mat2 BrownJacobian(const std::vector<double>& k, const Vec2& p) {
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double factor = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
  const double slope = 2 * (k[0] + r2 * (2 * k[1] + r2 * 3 * k[2]));
  const double t1 = k[3], t2 = k[4];
  const double mixed = x * y * slope + 2 * t1 * x + 2 * t2 * y;
  Mat2 jacobian;
  jacobian << factor + x * x * slope + 6 * t2 * x + 2 * t1 * y, mixed,  //
      mixed, factor + y * y * slope + 6 * t1 * y + 2 * t2 * x;
  return jacobian;
}

std::optional<Vec2> UndistortBrown(const std::vector<double>& k,
                                   const Vec2& distorted) {
  const OddPolynomial radial(k.data(), 3, kLargestRadius);
  Vec2 p = WithNorm(distorted,
                    radial.Solve(distorted.norm()).value_or(radial.limit()));
  constexpr int kIterations = 50;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Mat2 jacobian = BrownJacobian(k, p);
    // Positive definite on the sheet around the axis, up to its fold.
    if (!(jacobian.determinant() > 0 && jacobian.trace() > 0)) {
      return std::nullopt;
    }
    const Vec2 step =
        jacobian.inverse() * (Distort(CameraModel::kBrownT2, k, p) - distorted);
    p -= step;
    if (step.norm() <= 1e-15 * (1 + p.norm())) break;
  }
  const double error =
      (Distort(CameraModel::kBrownT2, k, p) - distorted).norm();
  if (!(error <= 1e-10 * (1 + distorted.norm()))) return std::nullopt;
  return p;
}

}  // namespace

std::optional<Vec2> Undistort(CameraModel model,
                              const std::vector<double>& coefficients,
                              const Vec2& distorted) {
  const int count = static_cast<int>(coefficients.size());
  switch (model) {
    case CameraModel::kPinhole:
    case CameraModel::kSpherical:
      return distorted;
    case CameraModel::kBrownT2:
      return UndistortBrown(coefficients, distorted);
    case CameraModel::kRadialK1:
    case CameraModel::kRadialK3: {
      const auto r = OddPolynomial(coefficients.data(), count, kLargestRadius)
                         .Solve(distorted.norm());
      if (!r) return std::nullopt;
      return WithNorm(distorted, *r);
    }
    case CameraModel::kFisheye: {
      const auto theta = OddPolynomial(coefficients.data(), count, 0.5 * kPi)
                             .Solve(distorted.norm());
      if (!theta) return std::nullopt;
      return WithNorm(distorted, std::tan(*theta));
    }
  }
  return std::nullopt;
}

}  // namespace lowlap
