#pragma once

#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// Another optimum of a pair's search, and the probability that it is nearer
/// the truth than the best.
struct RivalPose {
  RigidTransform pose;
  double weight = 0;
};

/// The weight of a motion whose score (PoseCandidate) is so many decimal digits
/// less than that of the best, which noise moves by 2.5 digits:
/// Phi(-deficit / 2.5).
double RivalWeight(double deficit_digits);

/// By how much `other` is off from `pose`: rotation in radians, in camera 2;
/// direction, at its full angle, in TangentBasis (as in RelativePose).
Eigen::Matrix<double, 5, 1> PoseError(const RigidTransform& pose,
                                      const RigidTransform& other);

/// What the rivals of a motion add to its covariance: that of the mixture about
/// the best, with errors e_k (PoseError),
///   sum w_k e_k e_k^T / (1 + sum w_k).
/// Few matches on few planes leave a valley of motions; the curvature at its
/// deepest place knows nothing of its length.
Eigen::Matrix<double, 5, 5> SpreadOfRivals(
    const RigidTransform& best, const std::vector<RivalPose>& rivals);

}  // namespace lowlap
