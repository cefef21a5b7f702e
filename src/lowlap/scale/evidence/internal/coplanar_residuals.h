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
/// reacts evenly at every tilt of the plane, where the distance of the closest
/// points in view j, d_co of the paper, is blind to planes that face j.
class TransferResiduals : public TwoSidedResiduals<TransferSide> {
 public:
  void Add(const TripletGeometry& geometry, const MatchedLine& a,
           const MatchedLine& b, double log_ratio);
};

}  // namespace lowlap
