#include "lowlap/geometry/internal/epipolar.h"

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

Mat3 EssentialFromPose(const RigidTransform& cam2_from_cam1) {
  return CrossMatrix(cam2_from_cam1.translation) * cam2_from_cam1.rotation;
}

double SampsonSquared(const Mat3& essential, const Vec3& x1, const Vec3& x2) {
  const Vec3 line2 = essential * x1;
  const Vec3 line1 = essential.transpose() * x2;
  const double gradient =
      line2.head<2>().squaredNorm() + line1.head<2>().squaredNorm();
  if (!(gradient > 0)) return 0;
  const double algebraic = x2.dot(line2);
  return algebraic * algebraic / gradient;
}

}  // namespace lowlap
