#pragma once

#include "lowlap/geometry/rigid_transform.h"

namespace lowlap {

/// To within an angle of rotation, and four times it of direction. Closer than
/// half a degree, refinement from either side is expected to meet.
bool SamePose(const RigidTransform& a, const RigidTransform& b,
              double within_deg = 0.5);

}  // namespace lowlap
