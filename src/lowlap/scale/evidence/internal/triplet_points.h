#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "lowlap/geometry/internal/triangulation.h"
#include "lowlap/scale/evidence/internal/residual_arrays.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// A point of three views in the frame of the middle camera, triangulated in
/// each pair at unit baseline.
struct TripletMidpoints {
  Vec3 from_i = Vec3::Zero();
  Vec3 from_k = Vec3::Zero();
};

/// The ratios of the points of one triplet (Salaün et al. 2017,
/// section 4, with the sign corrected).
///
/// With X from views (i, j) at lambda_i = 1 (midpoint of the rays), the
/// projection into k is v + tau w with
///   v = R_k X,  w = t_k,  u = the ray in k,
/// and tau_ijk = ClosestDirection(u, v, w): the one that turns the projection
/// closest to its observation.
class TripletPointSolver {
 public:
  explicit TripletPointSolver(const TripletGeometry& geometry);

  /// nullopt, `status` says why. Degenerate: the point lies on a baseline
  /// (parallel rays). Negative: behind one of the cameras.
  std::optional<TripletMidpoints> Midpoints(const TripletPoint& point,
                                            CandidateStatus* status) const;

  /// The ratio read from both ends, tau_ijk and 1 / tau_kji, combined in the
  /// log. To first order in a noise of one pixel in all three views, with v_n
  /// the velocity of the projection into n per unit of log tau and D_n the
  /// change of that projection with the observation in j (a move of the point
  /// at its depth):
  ///   var(log tau) = 1 / |v_i|^2 + 1 / |v_k|^2
  ///                  + |D_i^T v_i / |v_i|^2 - D_k^T v_k / |v_k|^2|^2.
  /// The last term is the largest where i and k are on opposite sides of j.
  RatioCandidate Ratio(const TripletPoint& point,
                       const TripletMidpoints& midpoints) const;
  RatioCandidate Ratio(const TripletPoint& point) const;

 private:
  TripletGeometry geometry_;
  RayTriangulator with_i_;
  RayTriangulator with_k_;
};

/// The distance of a projection to its observation, in one view.
struct PointSide {
  static constexpr int kColumns = 7, kLeastAt = 6;
  template <class Tau>
  static auto DistanceAt(const ResidualColumn* c, const Tau& tau, int n) {
    return ((First(c[0], n) + tau * First(c[1], n)).square() +
            (First(c[2], n) + tau * First(c[3], n)).square())
        .sqrt();
  }
  template <class Tau>
  static auto DepthAt(const ResidualColumn* c, const Tau& tau, int n) {
    return (First(c[4], n) + tau * First(c[5], n)).cwiseMax(kMinDepth);
  }
  template <class Tau>
  static auto At(const ResidualColumn* c, const Tau& tau, int n) {
    return DistanceAt(c, tau, n) / DepthAt(c, tau, n);
  }
  static float Of(const ResidualColumn* c, float tau, int n) {
    const float x = c[0][n] + tau * c[1][n], y = c[2][n] + tau * c[3][n];
    return std::sqrt(x * x + y * y) /
           std::max(kMinDepth, c[4][n] + tau * c[5][n]);
  }
};

/// The errors of points of three views: the distance from the projection into k
/// of the point triangulated in (i, j) to its observation, and likewise from
/// (k, j) into i; the mean of the two (Salaün et al. 2017, section 5).
class PointResiduals : public TwoSidedResiduals<PointSide> {
 public:
  void Reserve(int count);
  /// The point's ratio must be kValid.
  void Add(const TripletGeometry& geometry, const TripletPoint& point,
           const TripletMidpoints& midpoints, double log_ratio);
  /// Writes the errors of the first `count`.
  void Evaluate(double tau, int count, float* errors_px) const;
};

}  // namespace lowlap
