#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "lowlap/scale/evidence/internal/residual_arrays.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// The crossing of two lines in the middle view, x = l_a x l_b scaled to
/// z = 1; nullopt if they are parallel there or cross at infinity.
std::optional<Vec3> CrossingInMiddle(const NormalizedSegment& a,
                                     const NormalizedSegment& b);

/// The ratio at which line a (seen in i and j) and line b (seen in j and k)
/// meet, as coplanar lines do.
///
/// The ray through the crossing x of their images in j meets a at depth z_a
/// (from view i) and b at depth z_b (from view k), both at unit baseline, so
///   tau = z_a / z_b,  z_n = (q_n . b_n) / (q_n . x),  q_n = R_n^T l_n.
/// This equals the ratio of Salaün et al. 2017 (equation 16), without end
/// points and without the normal of the plane.
///
/// Standard deviation: to first order from all eight end points, each moving
/// across its segment by its stddev_px. With
///   g_a = b_a / (q_a . b_a) - x / (q_a . x),  h = q_b/(q_b.x) - q_a/(q_a.x),
/// log tau changes by g_a . dq_a - g_b . dq_b + h . dx, and dx = dl_a x l_b +
/// l_a x dl_b; the normal of a segment (s, e) changes by (n x e) / |s x e| per
/// unit of s along its image normal n. For one angular error s of all lines
/// this is s^2 sum [1/(q.b)^2 + 1/(q.x)^2] up to the error of x; here short
/// segments and crossings far beyond their ends are paid for.
///
/// Negative: z_a or z_b is negative. Degenerate: parallel lines; a line in an
/// epipolar plane (q.b near 0); a crossing at the vanishing point of a line
/// (q.x near 0, e.g. lines that are parallel in space); a hopeless standard
/// deviation. The plane may face the camera. Both lines must be in front of
/// camera j themselves, which LineInMiddle checks.
RatioCandidate CoplanarRatio(const TripletGeometry& geometry,
                             const MatchedLine& a, const MatchedLine& b);

/// A line of (i, j) or of (j, k), with what does not depend on its partner.
struct CoplanarLine {
  /// `camn_from_camj` at unit baseline, n being the line's neighbour.
  CoplanarLine(const RigidTransform& camn_from_camj, double focal_n_px,
               double focal_j_px, const MatchedLine& line);

  Vec3 normal;  // l, in the middle view
  Vec3 center;  // b, of the neighbour in the frame of camera j
  Vec3 q;
  double qb = 0;
  /// What start and end of the segment add to the normal, times the gradient
  /// with respect to it: in the neighbour (for q) and in the middle view.
  std::array<Vec3, 2> move_in_neighbor;
  std::array<Vec3, 2> move_in_middle;
};

/// The same for many pairs of some lines.
RatioCandidate CoplanarRatio(const CoplanarLine& a, const CoplanarLine& b);

/// How the log ratio of a pair moves when an end point of a line moves across
/// its segment by one standard deviation: start and end in the neighbour, start
/// and end in the middle view. Pairs that share a line share its noise. The sum
/// of the squares of both lines is log_ratio_stddev^2.
using CoplanarNoise = std::array<std::array<double, 4>, 2>;

/// Of a pair whose CoplanarRatio is valid.
CoplanarNoise NoiseOfCoplanarRatio(const TripletGeometry& geometry,
                                   const MatchedLine& a, const MatchedLine& b);

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
