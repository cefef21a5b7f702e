#include "lowlap/two_view/internal/search/refine_relative_pose.h"

#include <cmath>

#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using DirectionJacobian = Eigen::Matrix<double, 2, 3>;

struct PoseProblem {
  const PointPairs& pairs;
  const std::vector<int>& indices;
  const PoseRefinementOptions& options;

  NormalEquations<5> Linearize(const RigidTransform& pose) const {
    return LinearizePose(pose, pairs, indices, options);
  }
  double Cost(const RigidTransform& pose) const {
    return PoseCost(pose, pairs, indices, options);
  }
  static RigidTransform Moved(const RigidTransform& pose, const Vec5& step) {
    return MovedPose(pose, step);
  }
};

}  // namespace

double CauchyCost(double residual, double scale) {
  const double ratio = residual / scale;
  return 0.5 * scale * scale * std::log1p(ratio * ratio);
}

SampsonResidual::SampsonResidual(const RigidTransform& cam2_from_cam1,
                                 const PointPairs& pairs)
    : pairs_(pairs),
      essential_(EssentialFromPose(cam2_from_cam1)),
      weight1_(1 / (pairs.focal1_px * pairs.focal1_px)),
      weight2_(1 / (pairs.focal2_px * pairs.focal2_px)) {
  const Mat3& r = cam2_from_cam1.rotation;
  const Mat3 t_cross = CrossMatrix(cam2_from_cam1.translation);
  const auto basis = TangentBasis(cam2_from_cam1.translation);
  for (int k = 0; k < 5; ++k) {
    const Mat3 change = k < 3 ? Mat3(t_cross * CrossMatrix(Vec3::Unit(k)) * r)
                              : Mat3(CrossMatrix(basis.col(k - 3)) * r);
    for (int i = 0; i < 9; ++i) derivative_(i, k) = change(i / 3, i % 3);
  }
}

double SampsonResidual::Between(int first, int second, Vec5* jacobian) const {
  const Vec3& x1 = pairs_.x1[first];
  const Vec3& x2 = pairs_.x2[second];
  const Vec3 line2 = essential_ * x1;
  const Vec3 line1 = essential_.transpose() * x2;
  const double numerator = x2.dot(line2);
  const Vec2 spread2 =
      weight2_ * (pairs_.Covariance2(second) * line2.head<2>());
  const Vec2 spread1 = weight1_ * (pairs_.Covariance1(first) * line1.head<2>());
  const double squared_norm =
      line2.head<2>().dot(spread2) + line1.head<2>().dot(spread1);
  if (squared_norm < 1e-300) {
    if (jacobian != nullptr) jacobian->setZero();
    return 0;
  }
  const double inverse_norm = 1 / std::sqrt(squared_norm);
  if (jacobian != nullptr) {
    // dr/dE = (x2 - a) x1^T - x2 b^T, a and b from the norm's derivative.
    const double ratio = numerator / squared_norm;
    const Vec3 left(x2[0] - ratio * spread2[0], x2[1] - ratio * spread2[1],
                    x2[2]);
    const Vec2 right = ratio * spread1;
    Eigen::Matrix<double, 9, 1> gradient;
    for (int i = 0; i < 3; ++i) {
      gradient[3 * i] = left[i] * x1[0] - x2[i] * right[0];
      gradient[3 * i + 1] = left[i] * x1[1] - x2[i] * right[1];
      gradient[3 * i + 2] = left[i] * x1[2];
    }
    jacobian->noalias() = derivative_.transpose() * (inverse_norm * gradient);
  }
  return numerator * inverse_norm;
}

NormalEquations<5> LinearizePose(const RigidTransform& pose,
                                 const PointPairs& pairs,
                                 const std::vector<int>& indices,
                                 const PoseRefinementOptions& options) {
  const double scale = options.loss_scale_px;
  const SampsonResidual residual(pose, pairs);
  NormalEquations<5> system;
  Vec5 jacobian;
  for (const int i : indices) {
    const double r = residual(i, &jacobian);
    const double weight = 1 / (1 + (r / scale) * (r / scale));
    system.hessian.noalias() += (weight * jacobian) * jacobian.transpose();
    system.gradient += (weight * r) * jacobian;
    system.cost += CauchyCost(r, scale);
  }
  for (const DirectionPair& pair : options.directions) {
    DirectionJacobian turn;
    const Vec2 m = DirectionResidual(pair, pose.rotation, &turn);
    const double ratio = m.norm() / kDirectionLossScale;
    const double weight = options.point_variance_px2 / (1 + ratio * ratio);
    system.hessian.topLeftCorner<3, 3>() += weight * turn.transpose() * turn;
    system.gradient.head<3>() += weight * turn.transpose() * m;
    system.cost +=
        options.point_variance_px2 * CauchyCost(m.norm(), kDirectionLossScale);
  }
  return system;
}

double PoseCost(const RigidTransform& pose, const PointPairs& pairs,
                const std::vector<int>& indices,
                const PoseRefinementOptions& options) {
  const SampsonResidual residual(pose, pairs);
  double cost = 0;
  for (const int i : indices) {
    cost += CauchyCost(residual(i), options.loss_scale_px);
  }
  for (const DirectionPair& pair : options.directions) {
    cost += options.point_variance_px2 *
            CauchyCost(DirectionResidual(pair, pose.rotation).norm(),
                       kDirectionLossScale);
  }
  return cost;
}

RigidTransform MovedPose(const RigidTransform& pose, const Vec5& step) {
  const Vec3 rotation = step.head<3>();
  const Vec2 direction = step.tail<2>();
  return {RotationFromAngleAxis(rotation) * pose.rotation,
          (pose.translation + TangentBasis(pose.translation) * direction)
              .normalized()};
}

RigidTransform RefineRelativePose(const RigidTransform& cam2_from_cam1,
                                  const PointPairs& pairs,
                                  const std::vector<int>& indices,
                                  const PoseRefinementOptions& options) {
  if (indices.size() + 2 * options.directions.size() < 5 ||
      indices.size() < 2) {
    return cam2_from_cam1;
  }
  RigidTransform pose =
      MinimizeLevenbergMarquardt(PoseProblem{pairs, indices, options},
                                 cam2_from_cam1, options.max_iterations);
  pose.rotation = NearestRotation(pose.rotation);
  return pose;
}

std::optional<Mat5> RelativePoseCovariance(
    const RigidTransform& cam2_from_cam1, const PointPairs& pairs,
    const std::vector<int>& indices, const PoseRefinementOptions& options) {
  const SampsonResidual residual(cam2_from_cam1, pairs);
  SandwichCovariance<5> sandwich(pairs.common_error_side1);
  Vec5 jacobian;
  for (const int i : indices) {
    const double r = residual(i, &jacobian);
    const CauchyDerivatives<1> loss(Eigen::Matrix<double, 1, 1>(r),
                                    options.loss_scale_px);
    sandwich.Add<1>(pairs.x1[i].head<2>(), jacobian.transpose(), loss.gradient,
                    loss.hessian);
  }
  AddDirections(cam2_from_cam1, pairs, options, &sandwich);
  return sandwich.Solve();
}

}  // namespace lowlap
