#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Geometry>
#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// A measured relative pose, and how well it is known.
struct MeasuredRelativePose {
  Eigen::Quaterniond cam2_from_cam1;
  Eigen::Matrix<double, 3, 2> tangent_basis;
  Eigen::Matrix<double, 5, 5> sqrt_information;
};

/// How far a pair of poses is from its measured relative pose, in standard
/// deviations (5):
///   r = W (w, B^T t / |t|),  exp([w]x) = (R2 R1^T) R_measured^T,
///   t = R2 (C1 - C2),  B = TangentBasis(measured direction),
/// W^T W the inverse of the measured covariance; w to first order (twice the
/// vector part of the quaternion). Parameter blocks: rotation and centre of
/// view 1, rotation and centre of view 2.
class RelativePoseCost final : public ceres::SizedCostFunction<5, 4, 3, 4, 3> {
 public:
  explicit RelativePoseCost(const MeasuredRelativePose& measured)
      : measured_(measured) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  MeasuredRelativePose measured_;
};

/// A measured relative pose of two poses of the set.
struct RelativePosePrior {
  int first = -1;  // indices into CameraSet::poses
  int second = -1;
  RigidTransform cam2_from_cam1;  // with a translation of length 1
  MeasuredRelativePose measured;
};

/// Whether the poses still agree with it, to within ten degrees of rotation and
/// thirty of direction.
bool IsKept(const RelativePosePrior& prior, const CameraSet& cameras);

/// The relative poses of the scene that state a covariance and that the poses
/// agree with (IsKept; the others are false, and the loss would only be slow to
/// say so). What a
/// relative pose knows beyond the points and lines of the scene is the common
/// direction of parallel lines and the shape of the points' errors; where
/// structure is thin, that holds the poses. To the stated covariance come 0.1
/// degrees of rotation and 0.3 of direction, which no number of features
/// averages out: many points outweigh it.
std::vector<RelativePosePrior> LoadRelativePosePriors(const Scene& scene,
                                                      const CameraSet& cameras);

}  // namespace lowlap
