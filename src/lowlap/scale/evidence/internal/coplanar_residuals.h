#pragma once

#include "lowlap/scale/evidence/internal/residual_arrays.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// Coplanar pairs, transfer residual: the crossing x in view j, put at depth
/// z_a on line a, is projected into k, where its distance to line b is taken;
/// and x at depth z_b on line b into i, against line a; the mean of the two. It
/// reacts evenly at every tilt of the plane.
class TransferResiduals {
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
  static constexpr int kSide = 5;
  ResidualColumn column_[2 * kSide];
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
