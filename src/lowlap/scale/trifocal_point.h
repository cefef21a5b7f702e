#pragma once

#include <optional>

#include "lowlap/scale/triplet_geometry.h"

namespace lowlap {

/// The tau that turns the projection of a point into camera k closest to its
/// observation there (Salaün et al. 2017, section 4, with the sign corrected).
///
/// X in camera j's frame from views (i, j) at lambda_i = 1 (midpoint of the
/// rays); its projection into k is v + tau w with
///   v = R_k X,  w = t_k,  u = the ray in k,
/// and tau = ClosestDirection(u, v, w). nullopt: `status` says why.
/// Degenerate: the point lies on the baseline of (i, j) (parallel rays) or on
/// that of (j, k). Negative: behind one of the three cameras.
std::optional<double> TrifocalPointTau(const TripletGeometry& geometry,
                                       const TrifocalPoint& point,
                                       CandidateStatus* status);

/// The same read from both ends, tau_ijk and 1 / tau_kji, combined in the log.
/// To first order in a noise of one pixel in all three views, with v_n the
/// velocity of the projection into n per unit of log tau and D_n the change of
/// that projection with the observation in j (a move of the point at its
/// depth):
///   var(log tau) = 1 / |v_i|^2 + 1 / |v_k|^2
///                  + |D_i^T v_i / |v_i|^2 - D_k^T v_k / |v_k|^2|^2.
/// The last term is the largest where i and k are on opposite sides of j.
RatioCandidate TrifocalPointRatio(const TripletGeometry& geometry,
                                  const TrifocalPoint& point);

}  // namespace lowlap
