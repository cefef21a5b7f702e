#pragma once

#include <optional>

#include "lowlap/core/internal/random.h"
#include "lowlap/two_view/internal/planes/planar_motion.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "lowlap/two_view/internal/search/pose_search.h"

namespace lowlap {

/// The plane that holds most of the inliers of a candidate (DominantPlane).
std::optional<ScenePlane> DominantPlaneOf(const PoseCandidate& candidate,
                                          const PointPairs& pairs,
                                          Random& random);

/// The likelier motion of a pair and its dominant plane, and the other motion
/// that explains a scene whose points lie mostly on this plane.
struct PlanarDecision {
  PoseCandidate best;
  std::optional<ScenePlane> plane;
  std::optional<PoseCandidate> other;
  /// kGeneral where there is no other motion; kPlanar; kAmbiguousPlane.
  TwoViewGeometry geometry = TwoViewGeometry::kGeneral;
};

/// Decides between the best candidate of a search and the other motion that its
/// plane allows (MotionLead).
PlanarDecision DecidePlanarMotion(const PoseSearch& search,
                                  const PointPairs& pairs,
                                  const PoseCandidate& candidate,
                                  Random& random);

/// Whether all that speaks for the candidate lies on its plane
/// (ParallaxEvidence).
bool IsOfOnePlane(const PoseCandidate& candidate, const ScenePlane& plane,
                  const PointPairs& pairs);

}  // namespace lowlap
