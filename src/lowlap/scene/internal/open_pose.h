#pragma once

#include "lowlap/scene/relative_pose.h"

namespace lowlap {

/// A relative pose is open if nothing is known of it but that something joins
/// its views: each angle of its error has a standard deviation of a radian.
inline Eigen::Matrix<double, 5, 5> OpenCovariance() {
  return Eigen::Matrix<double, 5, 5>::Identity();
}

/// Whether its rotation is no better known than that.
inline bool IsOpen(const RelativePose& pose) {
  constexpr double kLeastVariance_rad2 = 0.99;
  return pose.covariance &&
         pose.covariance->topLeftCorner<3, 3>().trace() / 3 >=
             kLeastVariance_rad2;
}

}  // namespace lowlap
