#include "lowlap/averaging/centers/internal/evidence_against.h"

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

double EvidenceAgainstPoses(const Scene& scene, const PoseOptions& options) {
  double sum = 0;
  for (const auto& [views, measured] : scene.relative_poses) {
    const Pose* first = scene.FindPose(views.first);
    const Pose* second = scene.FindPose(views.second);
    if (first == nullptr || second == nullptr) continue;
    // lambda t = R_2 (C_1 - C_2).
    const Vec3 direction = second->rotation * (first->center - second->center);
    if (!(direction.norm() > 0)) continue;
    if (AngleBetween(direction, measured.direction) >
        LimitsOf(options).DirectionRad(0, DirectionStddev(measured))) {
      sum += EvidenceOfNfa(measured.log10_nfa);
    }
  }
  return sum;
}

}  // namespace lowlap
