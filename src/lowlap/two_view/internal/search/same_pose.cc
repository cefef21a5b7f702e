#include "lowlap/two_view/internal/search/same_pose.h"

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

bool SamePose(const RigidTransform& a, const RigidTransform& b,
              double within_deg) {
  const double within = RadFromDeg(within_deg);
  return RotationAngleBetween(a.rotation, b.rotation) < within &&
         AngleBetween(a.translation, b.translation) < 4 * within;
}

}  // namespace lowlap
