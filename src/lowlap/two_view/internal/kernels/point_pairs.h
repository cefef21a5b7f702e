#pragma once

#include <array>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Matched points of two views, normalised (z = 1), and the focal lengths that
/// turn their residuals into pixels (of the estimation: PixelUnit).
struct PointPairs {
  std::vector<Vec3> x1;
  std::vector<Vec3> x2;
  double focal1_px = 1;
  double focal2_px = 1;
  /// Shapes of their errors (LocalizationCovariance): a residual is divided by
  /// the deviation across the epipolar line. Empty: round, of variance 1.
  std::vector<Mat2> covariance1 = {};
  std::vector<Mat2> covariance2 = {};
  /// The two line matches that cross, of a crossing; negative for a point.
  /// Empty: all are points. Crossings that share a line err together.
  std::vector<std::array<int, 2>> lines = {};
  /// Side of a square of view 1, normalised, whose matches err together
  /// (SandwichCovariance); 0: all are independent.
  double common_error_side1 = 0;

  int size() const { return static_cast<int>(x1.size()); }
  const Mat2& Covariance1(int i) const { return At(covariance1, i); }
  const Mat2& Covariance2(int i) const { return At(covariance2, i); }

 private:
  static const Mat2& At(const std::vector<Mat2>& covariance, int i) {
    static const Mat2 kRound = Mat2::Identity();
    return covariance.empty() ? kRound : covariance[i];
  }
};

}  // namespace lowlap
