#pragma once

#include <vector>

#include "lowlap/averaging/rotations/internal/rotation_averaging.h"

namespace lowlap {

/// Turns what hangs on one edge of the spanning forest of least residuals, from
/// a single view to half of a component, to meet one of the other measurements
/// that lead to it, wherever that lowers RobustCost; in rounds, until no such
/// turn is left or ten are over. Least squares do not find such a turn: on the
/// way everything is worse. What a trusted measurement or more than 256 lead to
/// stays where it is.
///
/// Time of a round: constant for every view, plus a step for each edge of the
/// forest between the two views of a measurement.
void TurnBranches(const std::vector<RotationMeasurement>& measurements,
                  std::vector<Mat3>* cam_from_world);

}  // namespace lowlap
