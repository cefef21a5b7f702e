#pragma once

#include <algorithm>
#include <cmath>

#include "lowlap/scale/evidence/internal/residual_arrays.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// The distance of a carried crossing to a line, in one view.
struct TransferSide {
  static constexpr int kColumns = 5, kLeastAt = 4;
  template <class Tau>
  static auto At(const ResidualColumn* c, const Tau& tau, int n) {
    return (First(c[0], n) + tau * First(c[1], n)).abs() /
           (First(c[2], n) + tau * First(c[3], n)).cwiseMax(kMinDepth);
  }
  static float Of(const ResidualColumn* c, float tau, int n) {
    return std::abs(c[0][n] + tau * c[1][n]) /
           std::max(kMinDepth, c[2][n] + tau * c[3][n]);
  }
};

/// Coplanar pairs, transfer residual: the crossing x in view j, put at depth
/// z_a on line a, is projected into k, where its distance to line b is taken;
/// and x at depth z_b on line b into i, against line a; the mean of the two. It
/// reacts evenly at every tilt of the plane.
class TransferResiduals : public TwoSidedResiduals<TransferSide> {
 public:
  void Add(const TripletGeometry& geometry, const MatchedLine& a,
           const MatchedLine& b, double log_ratio);
};

/// Coplanar pairs, d_co of the paper: the point of line a closest to line b and
/// the point of b closest to a, both projected into view j; their distance.
/// With n = d_a x d_b and D = tau X_b - X_a:
///   P_ab = X_a + det[D, d_b, n]/|n|^2 d_a,
///   P_ba = tau X_b + det[D, d_a, n]/|n|^2 d_b.
/// Zero at every tau if the plane is perpendicular to the viewing ray. A pair
/// that is parallel in space has no closest points and a huge error.
class ClosestPointResiduals {
 public:
  void Add(const TripletGeometry& geometry, const MatchedLine& a,
           const MatchedLine& b, double log_ratio);
  int size() const { return static_cast<int>(column_[0].size()); }
  void Evaluate(double tau, int count, float* errors_px) const;
  float ErrorOf(double tau, int index) const;
  void Bound(double tau_low, double tau_high, float* least_px,
             float* most_px) const;
  int StationaryPoints(int index, double* taus) const;

 private:
  static constexpr int kColumns = 12;
  ResidualColumn column_[kColumns];
};

}  // namespace lowlap
