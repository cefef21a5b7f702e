#include "lowlap/two_view/internal/search/refine_relative_pose.h"

#include <cmath>

#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

struct NormalEquations {
  Mat5 hessian = Mat5::Zero();
  Vec5 gradient = Vec5::Zero();
  double cost = 0;
};

double CauchyCost(double residual, double scale) {
  const double ratio = residual / scale;
  return 0.5 * scale * scale * std::log1p(ratio * ratio);
}

using DirectionJacobian = Eigen::Matrix<double, 2, 3>;

NormalEquations Linearize(const RigidTransform& pose, const PointPairs& pairs,
                          const std::vector<int>& indices,
                          const PoseRefinementOptions& options) {
  const double scale = options.loss_scale_px;
  const SampsonResidual residual(pose, pairs);
  NormalEquations system;
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

double Cost(const RigidTransform& pose, const PointPairs& pairs,
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

RigidTransform Moved(const RigidTransform& pose, const Vec5& step) {
  const Vec3 rotation = step.head<3>();
  const Vec2 direction = step.tail<2>();
  return {RotationFromAngleAxis(rotation) * pose.rotation,
          (pose.translation + TangentBasis(pose.translation) * direction)
              .normalized()};
}

}  // namespace

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

RigidTransform RefineRelativePose(const RigidTransform& cam2_from_cam1,
                                  const PointPairs& pairs,
                                  const std::vector<int>& indices,
                                  const PoseRefinementOptions& options) {
  RigidTransform pose = cam2_from_cam1;
  if (indices.size() + 2 * options.directions.size() < 5 ||
      indices.size() < 2) {
    return pose;
  }
  double damping = 1e-4;
  NormalEquations system = Linearize(pose, pairs, indices, options);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    Mat5 damped = system.hessian;
    damped.diagonal() += damping * system.hessian.diagonal();
    const Vec5 step = -damped.ldlt().solve(system.gradient);
    if (!step.allFinite()) break;
    const RigidTransform moved = Moved(pose, step);
    if (Cost(moved, pairs, indices, options) <= system.cost) {
      pose = moved;
      damping = std::max(1e-10, damping * 0.1);
      if (step.norm() < 1e-9) break;
      system = Linearize(pose, pairs, indices, options);
    } else {
      if (step.norm() < 1e-9) break;
      damping = std::max(1e-6, damping * 10);
      if (damping > 1e6) break;
    }
  }
  pose.rotation = NearestRotation(pose.rotation);
  return pose;
}

Mat5 RelativePoseHessian(const RigidTransform& cam2_from_cam1,
                         const PointPairs& pairs,
                         const std::vector<int>& indices,
                         const PoseRefinementOptions& options) {
  return Linearize(cam2_from_cam1, pairs, indices, options).hessian;
}

bool IsWellDetermined(const Eigen::LDLT<Mat5>& factor) {
  return factor.info() == Eigen::Success &&
         factor.vectorD().minCoeff() > 1e-14 * factor.vectorD().maxCoeff();
}

std::optional<Mat5> RelativePoseCovariance(
    const RigidTransform& cam2_from_cam1, const PointPairs& pairs,
    const std::vector<int>& indices, const PoseRefinementOptions& options) {
  const double n = static_cast<double>(indices.size());
  if (n < 6) return std::nullopt;
  const SampsonResidual residual(cam2_from_cam1, pairs);
  Mat5 information = Mat5::Zero();
  double sum_squared_psi = 0;
  double sum_psi_slope = 0;
  Vec5 jacobian;
  for (const int i : indices) {
    const double r = residual(i, &jacobian);
    const double squared = std::pow(r / options.loss_scale_px, 2);
    const double weight = 1 / (1 + squared);
    information.noalias() += jacobian * jacobian.transpose();
    sum_squared_psi += weight * r * weight * r;
    sum_psi_slope += (1 - squared) * weight * weight;
  }
  const double slope = sum_psi_slope / n;
  if (!(slope > 0)) return std::nullopt;
  // Exact data have no scatter; rounding takes its place.
  information *= (n - 5) * slope * slope / std::max(sum_squared_psi, 1e-24 * n);
  for (const DirectionPair& pair : options.directions) {
    DirectionJacobian turn;
    const double ratio =
        DirectionResidual(pair, cam2_from_cam1.rotation, &turn).norm() /
        kDirectionLossScale;
    information.topLeftCorner<3, 3>() +=
        turn.transpose() * turn / (1 + ratio * ratio);
  }
  const Eigen::LDLT<Mat5> factor(information);
  if (!IsWellDetermined(factor)) return std::nullopt;
  const Mat5 covariance = factor.solve(Mat5::Identity());
  if (!covariance.allFinite()) return std::nullopt;
  return Mat5(0.5 * (covariance + covariance.transpose()));
}

}  // namespace lowlap
