#pragma once

#include <array>
#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

using FivePoints = std::array<Vec3, 5>;

/// Every real essential matrix with x2_n^T E x1_n = 0 for five matches.
///
/// E = x X + y Y + z Z + W over the null space of the five equations, put into
/// the cubic constraints det E = 0 and 2 E E^T E - tr(E E^T) E = 0, and
/// eliminated to a polynomial of degree ten in z (Nistér, "An efficient
/// solution to the five-point relative pose problem", PAMI 2004). Each root is
/// polished by Newton steps on the original equations.
///
/// Points are homogeneous, of any scale. At most ten matrices come back, each
/// with Frobenius norm sqrt(2) and singular values (1, 1, 0). Planar scenes
/// and forward motion are fine. Degenerate (repeated points, five points on a
/// line, no translation): no matrix, or matrices that satisfy the equations;
/// never one that does not.
std::vector<Mat3> EssentialFromFivePoints(const FivePoints& x1,
                                          const FivePoints& x2);

/// The four motions with E ~ [t]x R, |t| = 1: two rotations, t of either sign.
std::array<RigidTransform, 4> PosesFromEssential(const Mat3& essential);

}  // namespace lowlap
