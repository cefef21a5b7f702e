#include "lowlap/scene/relative_pose.h"

namespace lowlap {

const char* PoseWeaknessName(PoseWeakness weakness) {
  switch (weakness) {
    case PoseWeakness::kMatchesSideBySide:
      return "matches_side_by_side";
    case PoseWeakness::kSurroundings:
      return "surroundings";
    case PoseWeakness::kRepeats:
      return "repeats";
  }
  return "";
}

RelativePose RelativePose::WithMotion(const AlternativeMotion& motion) const {
  RelativePose result = *this;
  result.rotation = motion.rotation;
  result.direction = motion.direction;
  result.log10_nfa = motion.log10_nfa;
  result.covariance = motion.covariance;
  result.alternatives.clear();
  return result;
}

bool operator==(const RelativePose& a, const RelativePose& b) {
  return a.views == b.views && a.rotation == b.rotation &&
         a.direction == b.direction && a.point_inliers == b.point_inliers &&
         a.line_inliers == b.line_inliers && a.log10_nfa == b.log10_nfa &&
         a.point_threshold_px == b.point_threshold_px &&
         a.covariance == b.covariance && a.alternatives == b.alternatives &&
         a.weakness == b.weakness;
}

RigidTransform UnitTransform(const RelativePose& edge, ViewId from, ViewId to) {
  const RigidTransform cam2_from_cam1 = edge.Cam2FromCam1();
  return (edge.views == ViewPair{from, to}) ? cam2_from_cam1
                                            : cam2_from_cam1.Inverse();
}

}  // namespace lowlap
