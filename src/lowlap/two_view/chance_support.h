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

/// Whether the matches show a translation at all, or the noise hides it.
struct TranslationEvidence {
  /// Matches of `inliers` that a rotation alone explains.
  int num_rotation_inliers = 0;
  /// log10 NFA of the translation, >= 0 if there is no evidence for one.
  /// -infinity where rotation alone explains less than half of the inliers.
  double log10_nfa = 0;
};

/// A rotation is fitted to the inliers of the pose and explains those it
/// transfers to within 3 `threshold_px`. If that is most of them, the
/// translation must prove itself: seen from where the rotation puts it (R x1),
/// every point of camera 2 should lie along its epipolar line, on the side of
/// positive depth. Without translation the angle between the two directions is
/// uniform in [0, pi], whatever the sizes of noise and depths; permuted matches
/// correct for images whose points crowd.
TranslationEvidence TestTranslation(const PointPairs& pairs,
                                    const RigidTransform& cam2_from_cam1,
                                    const std::vector<int>& inliers,
                                    double threshold_px);

}  // namespace lowlap
