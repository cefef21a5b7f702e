#pragma once

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/two_view/internal/kernels/essential_kernel.h"

namespace lowlap {

struct SharpenedPoses {
  /// Local optima, the sharpest first; one of thousands of matches, more of
  /// few.
  std::vector<RigidTransform> cam2_from_cam1;
  double scale_px = 0;  // the scale s at which they were found
};

/// The poses near `cam2_from_cam1` with the sharpest core of small residuals.
///
/// Repeated structure (windows in a row) leaves many wrong matches a few pixels
/// beside their epipolar lines. The pose of least NFA bends towards them: they
/// add inliers, at the price of residuals that are all a little larger. The
/// right pose is told from it by the core: it maximises the truncated Cauchy
/// score
///   sum log(1 + 9) - log(1 + min(r^2 / s^2, 9)),
/// s the precision of the points. Five-point samples from the inliers at
/// `threshold_px`, scored on the matches within twice that (on all of few
/// hundred), the best ones refined. Few matches allow several motions about as
/// well: the fewer, the more samples are drawn and refined, so that the same
/// ones are found whatever the seed. s starts at the 0.3 pixels of a good
/// detector and doubles until the core (r <= 3 s) holds at least half of those
/// inliers, so that noisier points and imperfect calibrations are served too.
SharpenedPoses SharpenPose(const EssentialKernel& kernel,
                           const RigidTransform& cam2_from_cam1,
                           double threshold_px, Random& random);

}  // namespace lowlap
