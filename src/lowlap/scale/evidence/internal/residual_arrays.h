#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace lowlap {

// Errors of many candidates at one tau. With one unknown every projection is
// v + tau w, so that an error is a quotient of functions linear in tau; their
// coefficients are computed once, in double precision and scaled to the
// candidate's own ratio, and evaluated in single precision (which is good to
// 0.01 px) over whole arrays. An error is huge (over 1e6) or not finite where
// the candidate would lie behind a camera.

/// One coefficient of all candidates.
using ResidualColumn = std::vector<float>;

/// Below this share of its value at the candidate's own ratio, a depth counts
/// as behind the camera; the error then comes out huge.
inline constexpr float kMinDepth = 1e-7f;

inline void Push(ResidualColumn& column, double value) {
  column.push_back(static_cast<float>(value));
}

/// The first `count` coefficients.
inline Eigen::Map<const Eigen::ArrayXf> First(const ResidualColumn& column,
                                              int count) {
  return {column.data(), static_cast<Eigen::Index>(count)};
}

/// Where a side lies least in the interval, for a minimum at column `least_at`.
inline auto Clamped(const ResidualColumn& least_at, int count, float low,
                    float high) {
  return First(least_at, count).cwiseMax(low).cwiseMin(high);
}

/// A little below or above, for what rounding does to the errors.
inline constexpr float kRoundingPx = 1e-3f;
inline constexpr float kRounding = 1e-5f;

inline float Lowered(float least_px) {
  return std::max(0.0f, least_px * (1 - kRounding) - kRoundingPx);
}
inline float Raised(float most_px) {
  return most_px * (1 + kRounding) + kRoundingPx;
}

/// The same for arrays that may be null.
inline void Widen(int count, float* least_px, float* most_px) {
  using Map = Eigen::Map<Eigen::ArrayXf>;
  if (least_px != nullptr) {
    Map least(least_px, count);
    least = (least * (1 - kRounding) - kRoundingPx).cwiseMax(0.0f);
  }
  if (most_px != nullptr) {
    Map most(most_px, count);
    most = most * (1 + kRounding) + kRoundingPx;
  }
}

/// The mean of the errors in two views. Of the columns of one view, Side has
///   static constexpr int kColumns, kLeastAt;  where the error is least
///   static auto At(columns, tau, n);          the first n; a tau, or n of them
///   static float Of(columns, tau, n);         the n-th
template <class Side>
class TwoSidedResiduals {
 public:
  int size() const { return static_cast<int>(column_[0].size()); }

  float ErrorOf(double tau, int index) const {
    const float t = static_cast<float>(tau);
    return 0.5f *
           (Side::Of(column_, t, index) + Side::Of(column_ + kSide, t, index));
  }

  void Evaluate(double tau, int count, float* errors_px) const {
    const float t = static_cast<float>(tau);
    Eigen::Map<Eigen::ArrayXf>(errors_px, count) =
        0.5f *
        (Side::At(column_, t, count) + Side::At(column_ + kSide, t, count));
  }

  void Bound(double tau_low, double tau_high, float* least_px,
             float* most_px) const {
    const float low = static_cast<float>(tau_low);
    const float high = static_cast<float>(tau_high);
    const ResidualColumn* const c = column_;
    const ResidualColumn* const d = column_ + kSide;
    const int n = size();
    if (least_px != nullptr) {
      Eigen::Map<Eigen::ArrayXf>(least_px, n) =
          0.5f * (Side::At(c, Clamped(c[Side::kLeastAt], n, low, high), n) +
                  Side::At(d, Clamped(d[Side::kLeastAt], n, low, high), n));
    }
    if (most_px != nullptr) {
      Eigen::Map<Eigen::ArrayXf>(most_px, n) =
          0.5f * (Side::At(c, low, n).cwiseMax(Side::At(c, high, n)) +
                  Side::At(d, low, n).cwiseMax(Side::At(d, high, n)));
    }
    Widen(n, least_px, most_px);
  }

  int StationaryPoints(int index, double* taus) const {
    taus[0] = column_[Side::kLeastAt][index];
    taus[1] = column_[kSide + Side::kLeastAt][index];
    return 2;
  }

 protected:
  static constexpr int kSide = Side::kColumns;
  ResidualColumn column_[2 * kSide];
};

}  // namespace lowlap
