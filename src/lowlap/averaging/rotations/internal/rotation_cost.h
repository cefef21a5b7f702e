#pragma once

#include <vector>

#include "lowlap/averaging/rotations/internal/rotation_averaging.h"

namespace lowlap {

/// log(R_second^T second_from_first R_first): the turn of the second view, in
/// the world, that meets the measurement.
Vec3 RotationResidual(const RotationMeasurement& m,
                      const std::vector<Mat3>& cam_from_world);

/// Evidence weighs, but only with its logarithm: a relative pose of thousands
/// of matches may be wrong as well.
double EvidenceWeight(const RotationMeasurement& m);

/// What a measurement that is off by an angle adds to RobustCost.
double CostOfAngle(const RotationMeasurement& m, double angle_rad);

/// What solutions are compared by:
///   sum_e (1 + log(1 + max(0, -cost_e))) log(1 + (r_e / sigma_e)^2).
double RobustCost(const std::vector<RotationMeasurement>& measurements,
                  const std::vector<Mat3>& cam_from_world);

}  // namespace lowlap
