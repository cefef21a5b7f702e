#include "lowlap/two_view/internal/planes/planar_decision.h"

#include <utility>

#include "lowlap/two_view/internal/planes/motion_lead.h"
#include "lowlap/two_view/internal/planes/parallax_evidence.h"
#include "lowlap/two_view/internal/search/same_pose.h"

namespace lowlap {
namespace {

/// A plane that holds this share of the inliers may be all that speaks for the
/// motion, and is worth a second one.
constexpr double kPlaneShare = 0.5;

bool HoldsMost(const ScenePlane& plane, const PoseCandidate& candidate) {
  return static_cast<double>(plane.inliers.size()) >=
         kPlaneShare * static_cast<double>(candidate.inliers.size());
}

std::optional<PoseCandidate> PlanarAlternative(const PoseSearch& search,
                                               const PointPairs& pairs,
                                               const PoseCandidate& candidate,
                                               const ScenePlane& plane) {
  if (!HoldsMost(plane, candidate)) return std::nullopt;
  const std::optional<RigidTransform> motion = OtherPlanarMotion(
      candidate.pose, plane.normal, pairs.x1[plane.inliers.front()]);
  if (!motion) return std::nullopt;
  return search.Finish(*motion);
}

}  // namespace

std::optional<ScenePlane> DominantPlaneOf(const PoseCandidate& candidate,
                                          const PointPairs& pairs,
                                          Random& random) {
  return DominantPlane(candidate.pose, pairs, candidate.inliers,
                       candidate.support.threshold, random);
}

PlanarDecision DecidePlanarMotion(const PoseSearch& search,
                                  const PointPairs& pairs,
                                  const PoseCandidate& candidate,
                                  Random& random) {
  PlanarDecision decision;
  auto& [best, plane, other, geometry] = decision;
  best = candidate;
  plane = DominantPlaneOf(best, pairs, random);
  if (plane) other = PlanarAlternative(search, pairs, best, *plane);
  if (!other) return decision;
  // Few matches may leave the other motion none in front of the cameras.
  bool is_decided = true;
  if (other->IsMeaningful()) {
    std::optional<ScenePlane> plane_of_other =
        DominantPlaneOf(*other, pairs, random);
    const MotionLead lead =
        CompareMotions(search, pairs, best, *plane, *other,
                       plane_of_other ? &*plane_of_other : nullptr);
    is_decided = lead.IsDecisive();
    if (lead.IsBehind()) {
      std::swap(best, *other);
      std::swap(plane, plane_of_other);
    }
  }
  // Where both are one motion, the better optimum of it is kept.
  if (!SamePose(best.pose, other->pose)) {
    geometry = is_decided ? TwoViewGeometry::kPlanar
                          : TwoViewGeometry::kAmbiguousPlane;
  }
  return decision;
}

bool IsOfOnePlane(const PoseCandidate& candidate, const ScenePlane& plane,
                  const PointPairs& pairs) {
  return HoldsMost(plane, candidate) &&
         !(ParallaxEvidence(candidate.pose, plane, pairs,
                            candidate.support.threshold) < 0);
}

}  // namespace lowlap
