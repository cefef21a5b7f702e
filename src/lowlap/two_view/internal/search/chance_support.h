#pragma once

#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/robust/internal/a_contrario.h"
#include "lowlap/two_view/internal/kernels/essential_kernel.h"

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

/// The share of wrong matches that are visible and within `threshold_px` by
/// chance, found in the same way.
double ChanceShare(const PointPairs& pairs,
                   const RigidTransform& cam2_from_cam1, double threshold_px);

}  // namespace lowlap
