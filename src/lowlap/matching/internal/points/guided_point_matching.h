#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/features/internal/points/point_detector.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/matching/guided_match_options.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// The points of one view; all vectors have the same length and order. Not
/// owned.
struct PointView {
  const std::vector<Keypoint>& keypoints;
  const std::vector<PointDescriptor>& descriptors;
  const NormalizedFeatures& features;
};

/// Point matches under a known relative pose (at any baseline but zero): the
/// candidates of a point are those of the other image within `threshold_px` of
/// the epipolar constraint (Sampson distance) that lie in front of both
/// cameras, up to the threshold at infinity, and whose scale and orientation
/// agree with the motion. Few are left, hence far fewer look alike than in the
/// whole image; what is lost is that an accidental nearest stands alone, so
/// the descriptor must also be nearer than to a sample of points taken
/// regardless of the geometry. Both tests hold from either image, and matches
/// are mutual; sorted by the first index, every feature at most once. Points
/// that only tilted images show (Keypoint::tilt) take no part.
///
/// Points within a degree of an epipole have no depth and are left out.
/// Descriptor distances are exact, in integers. With c candidates per point
/// the cost is O(n log n + n c).
std::vector<FeatureMatch> MatchPointsGuided(
    const PointView& first, const PointView& second,
    const RigidTransform& cam2_from_cam1, double threshold_px,
    const GuidedPointOptions& options);

}  // namespace lowlap
