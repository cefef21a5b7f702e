#pragma once

#include <vector>

#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/relative_pose.h"

namespace lowlap {

/// A candidate that takes part in a mean, with its weight there.
struct WeightedCandidate {
  int kind = 0;   // as in RatioSupport
  int index = 0;  // within its kind
  double weight = 1;
};

/// The triplet's geometry moved by one standard deviation along each of the
/// five independent errors, and against it, of the relative pose `edge`, which
/// is the one with camera i, or k (the eigenvectors of its covariance;
/// rotations exp([w]x) R, directions normalised d + B delta with B =
/// TangentBasis(d)). Empty without a covariance, or with one that is not finite
/// and positive semidefinite.
std::vector<TripletGeometry> PerturbPose(const TripletGeometry& geometry,
                                         const RelativePose& edge,
                                         const ViewTriplet& views);

/// The variance of a weighted mean of the candidates' log ratios that comes
/// from the errors of the two relative poses: all candidates move together with
/// them, so that it does not fall with their number. The sum over the errors of
/// `triplet.pose_perturbations`, each there and back, of the mean of the two
/// squared changes: a large error along a valley changes the ratio far more on
/// one side than on the other. A way that leaves no candidate a valid ratio is
/// one that the poses cannot be off, and counts as no change; if both are, the
/// poses do not tell the ratio, and the error counts as kMaxLogRatioStddev. So
/// does one that turns a camera by more than half a radian, where candidates
/// are left by chance. The mean is taken over a sample of at most 24 candidates
/// of each kind, even by ratio.
double PoseVariance(const TripletView& triplet, const RatioSupport& support,
                    const std::vector<WeightedCandidate>& candidates);

}  // namespace lowlap
