#pragma once

#include <cstdint>

#include "lowlap/geometry/types.h"
#include "lowlap/scene/relative_pose.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"

namespace lowlap {

/// What is known of the rotation of a pair from elsewhere, such as the other
/// relative poses of a loop.
struct RotationPrior {
  Mat3 cam2_from_cam1 = Mat3::Identity();
  double stddev_rad = 0;  // about each axis
};

/// What a rotation has against the prior, in decimal digits: at most three, for
/// the prior may be wrong, too.
double PriorPenalty(const RotationPrior& prior, const Mat3& rotation);

struct InformedPose {
  RelativePose pose;
  /// By how much more matches, directions and prior together speak for it than
  /// for the pose it was made from, in decimal digits; 0 at least.
  double gained_digits = 0;
  /// That of the prior alone.
  double prior_digits = 0;
};

/// The motion that the matches of a pair and a prior of its rotation bear out
/// together. Few matches on few planes leave a valley of motions that explain
/// them about as well; the prior says where in it the right one lies.
///
/// Candidates are the pose itself, and the motion of the prior's rotation with
/// the translation of two-point samples, both refined with the prior. The one
/// of the greatest score (PoseCandidate), less PriorPenalty, wins. Covariance
/// and inliers are those with the prior; the evidence (log10_nfa) stays that of
/// the matches alone. Where too few matches are usable, or chance explains
/// that they fit the new motion (log10 NFA >= 0), the pose comes back as it
/// was.
InformedPose InformPose(const TwoViewInput& input, const RelativePose& pose,
                        const RotationPrior& prior, std::uint64_t seed);

}  // namespace lowlap
