#pragma once

#include <vector>

#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/core/result.h"

namespace lowlap {

struct BoundedLengthsOptions {
  /// In lengths of the shortest edge; infinite: least squares.
  double loss_width = 0.01;
  int max_iterations = 300;

  static BoundedLengthsOptions L2Chordal();
  static BoundedLengthsOptions SoftL1();
  static BoundedLengthsOptions Lud();

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("loss_width", &loss_width,
          "where the loss goes from squares to absolute values, in lengths of "
          "the shortest edge");
    visit("max_iterations", &max_iterations, "at most so many iterations");
  }
};

/// Centres from directions with lengths of at least one:
///
///   min over C, s  sum_e phi(|C_j - C_i - s_e d_e|),   s_e >= 1,
///   phi(r) = b^2 (sqrt(1 + (r / b)^2) - 1).
///
/// Least squares for residuals below the width b, absolute values above; an
/// infinite width is least squares, phi = r^2 / 2. The bound keeps the centres
/// from collapsing; lengths are in units of the shortest edge. Convex, so the
/// start does not matter. Three published methods differ in b:
///
/// - l2_chordal, b infinite (Tron & Vidal, "Distributed image-based 3-D
///   localization of camera sensor networks", CDC 2009): not robust, one wrong
///   direction bends everything near it, and long edges weigh more than short
///   ones.
/// - soft_l1, b = 0.01 (Moulon, Monasse, Perrot, Marlet, "OpenMVG: Open
///   multiple view geometry", 2016), on pairwise directions.
/// - lud, b = 1e-6 (Ozyesil & Singer, "Robust camera location estimation by
///   convex programming", CVPR 2015): exact in spite of some wrong directions
///   if the others are exact.
///
/// Unweighted, as published. s_e = max(1, d_e . (C_j - C_i)) is eliminated,
/// which leaves a convex function of C with a continuous gradient. It is
/// minimised by Newton's method on the current set of bounded lengths with the
/// weights phi'(r) / r (reweighted least squares), and a line search; sparse
/// LDL^T; until the objective decreases by less than 1e-13 of itself. Narrow
/// losses converge slowly from far away: it begins with least squares from
/// lengths of one, then takes tenfold narrower losses down to the width.
/// `max_iterations` are those of the last one. The first view is at the origin.
/// Adds to `num_iterations`; kNumerical if a factorisation fails; kCancelled.
Result<std::vector<Vec3>> SolveBoundedLengths(
    const DirectionPart& part, const BoundedLengthsOptions& options,
    const RunContext& context, int* num_iterations);

/// The objective with the width b.
double BoundedObjective(const DirectionPart& part, double width,
                        const std::vector<Vec3>& centers);

}  // namespace lowlap
