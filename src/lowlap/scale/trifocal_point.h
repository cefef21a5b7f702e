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

/// The same read from both ends, tau_ijk and 1 / tau_kji, combined in the log;
/// half their difference is part of the standard deviation. To first order in
/// the noise of the outer observations, with s the speed of the projection in
/// pixels per unit of log tau: var(log tau) = 1 / s_i^2 + 1 / s_k^2.
RatioCandidate TrifocalPointRatio(const TripletGeometry& geometry,
                                  const TrifocalPoint& point);

}  // namespace lowlap
