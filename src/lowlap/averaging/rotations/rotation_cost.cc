#include "lowlap/averaging/rotations/internal/rotation_cost.h"

#include <algorithm>
#include <cmath>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

Vec3 RotationResidual(const RotationMeasurement& m,
                      const std::vector<Mat3>& cam_from_world) {
  return AngleAxisFromRotation(cam_from_world[m.second].transpose() *
                               m.second_from_first * cam_from_world[m.first]);
}

double EvidenceWeight(const RotationMeasurement& m) {
  return 1 + std::log1p(std::max(0.0, -m.cost));
}

double CostOfAngle(const RotationMeasurement& m, double angle_rad) {
  const double x = angle_rad / m.stddev_rad;
  return EvidenceWeight(m) * std::log1p(x * x);
}

double RobustCost(const std::vector<RotationMeasurement>& measurements,
                  const std::vector<Mat3>& cam_from_world) {
  double cost = 0;
  for (const RotationMeasurement& m : measurements) {
    cost += CostOfAngle(m, RotationResidual(m, cam_from_world).norm());
  }
  return cost;
}

}  // namespace lowlap
