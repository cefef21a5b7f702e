#pragma once

#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/robust/a_contrario.h"
#include "lowlap/two_view/essential_kernel.h"

namespace lowlap {

/// Step of every match on the ladder of Sampson residuals; matches behind a
/// camera get ladder.NumSteps(). Rays that are parallel to within the residual
/// count as visible: their depth has no sign.
std::vector<int> VisibleSteps(const EssentialKernel& kernel,
                              const AContrarioLadder& ladder,
                              const RigidTransform& cam2_from_cam1);

/// The score of a pose against the chance support that it has in these very
/// images: the same points, matched at random (cyclic shifts of the second
/// points, which are in random order), tell how often a wrong match is visible
/// and within each threshold. Points that crowd in a band, or around the
/// epipole, agree with a wrong pose far more often than the uniform law says.
AContrarioScore ScoreAgainstChance(const EssentialKernel& kernel,
                                   const AContrarioLadder& ladder,
                                   const RigidTransform& cam2_from_cam1);

/// log10 NFA of the translation: that the points of camera 2 lie, seen from
/// where the rotation alone puts them (R x1), along the epipolar lines, on the
/// side of positive depth. Without translation the angle between the two
/// directions is uniform in [0, pi], whatever the sizes of noise and depths;
/// permuted matches correct for images whose points crowd. >= 0: the matches
/// do not show a translation. Matches whose R x1 is behind camera 2 count as
/// not aligned.
double DirectionLog10Nfa(const PointPairs& pairs,
                         const RigidTransform& cam2_from_cam1);

}  // namespace lowlap
