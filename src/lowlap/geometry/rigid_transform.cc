#include "lowlap/geometry/rigid_transform.h"

namespace lowlap {

Mat34 RigidTransform::Matrix() const {
  Mat34 matrix;
  matrix << rotation, translation;
  return matrix;
}

}  // namespace lowlap
