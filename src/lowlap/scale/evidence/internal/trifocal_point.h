#pragma once

#include <optional>

#include "lowlap/geometry/triangulation.h"
#include "lowlap/scale/triplet_geometry.h"

namespace lowlap {

/// A trifocal point in the frame of the middle camera, triangulated in each
/// pair at unit baseline.
struct TrifocalMidpoints {
  Vec3 from_i = Vec3::Zero();
  Vec3 from_k = Vec3::Zero();
};

/// The ratios of the trifocal points of one triplet (Salaün et al. 2017,
/// section 4, with the sign corrected).
///
/// With X from views (i, j) at lambda_i = 1 (midpoint of the rays), the
/// projection into k is v + tau w with
///   v = R_k X,  w = t_k,  u = the ray in k,
/// and tau_ijk = ClosestDirection(u, v, w): the one that turns the projection
/// closest to its observation.
class TrifocalPointSolver {
 public:
  explicit TrifocalPointSolver(const TripletGeometry& geometry);

  /// nullopt, `status` says why. Degenerate: the point lies on a baseline
  /// (parallel rays). Negative: behind one of the cameras.
  std::optional<TrifocalMidpoints> Midpoints(const TrifocalPoint& point,
                                             CandidateStatus* status) const;

  /// The ratio read from both ends, tau_ijk and 1 / tau_kji, combined in the
  /// log. To first order in a noise of one pixel in all three views, with v_n
  /// the velocity of the projection into n per unit of log tau and D_n the
  /// change of that projection with the observation in j (a move of the point
  /// at its depth):
  ///   var(log tau) = 1 / |v_i|^2 + 1 / |v_k|^2
  ///                  + |D_i^T v_i / |v_i|^2 - D_k^T v_k / |v_k|^2|^2.
  /// The last term is the largest where i and k are on opposite sides of j.
  RatioCandidate Ratio(const TrifocalPoint& point,
                       const TrifocalMidpoints& midpoints) const;
  RatioCandidate Ratio(const TrifocalPoint& point) const;

 private:
  TripletGeometry geometry_;
  RayTriangulator with_i_;
  RayTriangulator with_k_;
};

}  // namespace lowlap
