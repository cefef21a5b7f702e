#pragma once

#include <optional>

#include "lowlap/geometry/plucker_line.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// The depth in camera j at which the ray through x (normalised, in j) meets
/// the interpretation plane of a line seen in a neighbour n, at unit baseline:
///   z = (q . b) / (q . x),  q = R_n^T l_n,  b the centre of n in j.
/// For x on the line's image in j it is the depth of the 3D line. Infinite or
/// NaN if the ray is parallel to the plane.
double DepthOnPlane(const RigidTransform& camn_from_camj, const Vec3& normal_n,
                    const Vec3& x);

/// The 3D line of a match, in camera j's frame at unit baseline. nullopt:
/// degenerate (the line lies in an epipolar plane, or a segment is not valid),
/// or negative: an end point of the segment in j would be behind camera j.
/// `status` says which.
std::optional<PluckerLine> LineInMiddle(const RigidTransform& camn_from_camj,
                                        const NormalizedSegment& in_j,
                                        const NormalizedSegment& in_n,
                                        CandidateStatus* status);

}  // namespace lowlap
