#pragma once

#include "lowlap/two_view/internal/planes/planar_motion.h"
#include "lowlap/two_view/internal/search/pose_search.h"

namespace lowlap {

/// By how much one of the two motions of a plane leads the other, as natural
/// logarithms: the core scores of the points, and what the directions have
/// against them.
///
/// The two explain the points of the plane alike. How these fit one motion
/// better than the other is how their errors fell, and grows with the square
/// root of their number.
struct MotionLead {
  double of_all = 0;
  /// What errors alone make of `of_all`: for leads a of the single points of
  /// the plane, whose sum is 0 on average, sqrt(sum a^2).
  double noise = 0;
  /// Without the points of the plane: the directions, and the DisplacedMatches
  /// where they bear either motion out (ParallaxEvidence < 0).
  double beside_plane = 0;

  /// The motions are told apart: by ten points that fit one perfectly and the
  /// other not at all, 10 log(10), and three times what noise makes.
  bool IsDecisive() const;

  /// The other motion is the likelier one. Where that is not decided and what
  /// is beside the plane tells by a factor of ten, this does.
  bool IsBehind() const;
};

/// That of `first`, whose inliers lie mostly on its plane, over `second`; null:
/// that one has no plane.
MotionLead CompareMotions(const PoseSearch& search, const PointPairs& pairs,
                          const PoseCandidate& first,
                          const ScenePlane& plane_of_first,
                          const PoseCandidate& second,
                          const ScenePlane* plane_of_second);

}  // namespace lowlap
