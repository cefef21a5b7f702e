#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "lowlap/scene/view.h"

namespace lowlap {

/// The standard deviation of the centre along the axis in which it is known
/// least, in world units: the root of the largest eigenvalue of
/// Pose::center_covariance. Absent if that is.
inline std::optional<double> CenterStddev(const Pose& pose) {
  if (!pose.center_covariance) return std::nullopt;
  const Vec3 variances = Eigen::SelfAdjointEigenSolver<Mat3>(
                             *pose.center_covariance, Eigen::EigenvaluesOnly)
                             .eigenvalues();
  return std::sqrt(std::max(0.0, variances.maxCoeff()));
}

}  // namespace lowlap
