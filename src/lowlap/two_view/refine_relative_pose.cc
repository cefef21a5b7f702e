#include "lowlap/two_view/refine_relative_pose.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "lowlap/geometry/epipolar.h"
#include "lowlap/geometry/rotation.h"

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

NormalEquations Linearize(const RigidTransform& pose, const PointPairs& pairs,
                          const std::vector<int>& indices, double scale) {
  const SampsonResidual residual(pose, pairs.focal1_px, pairs.focal2_px);
  NormalEquations system;
  Vec5 jacobian;
  for (const int i : indices) {
    const double r = residual(pairs.x1[i], pairs.x2[i], &jacobian);
    const double weight = 1 / (1 + (r / scale) * (r / scale));
    system.hessian.noalias() += (weight * jacobian) * jacobian.transpose();
    system.gradient += (weight * r) * jacobian;
    system.cost += CauchyCost(r, scale);
  }
  return system;
}

double Cost(const RigidTransform& pose, const PointPairs& pairs,
            const std::vector<int>& indices, double scale) {
  const SampsonResidual residual(pose, pairs.focal1_px, pairs.focal2_px);
  double cost = 0;
  for (const int i : indices) {
    cost += CauchyCost(residual(pairs.x1[i], pairs.x2[i]), scale);
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
                                 double focal1_px, double focal2_px)
    : essential_(EssentialFromPose(cam2_from_cam1)),
      weight1_(1 / (focal1_px * focal1_px)),
      weight2_(1 / (focal2_px * focal2_px)) {
  const Mat3& r = cam2_from_cam1.rotation;
  const Mat3 t_cross = CrossMatrix(cam2_from_cam1.translation);
  const auto basis = TangentBasis(cam2_from_cam1.translation);
  for (int k = 0; k < 5; ++k) {
    const Mat3 change = k < 3 ? Mat3(t_cross * CrossMatrix(Vec3::Unit(k)) * r)
                              : Mat3(CrossMatrix(basis.col(k - 3)) * r);
    for (int i = 0; i < 9; ++i) derivative_(i, k) = change(i / 3, i % 3);
  }
}

double SampsonResidual::operator()(const Vec3& x1, const Vec3& x2,
                                   Vec5* jacobian) const {
  const Vec3 line2 = essential_ * x1;
  const Vec3 line1 = essential_.transpose() * x2;
  const double numerator = x2.dot(line2);
  const double squared_norm = weight2_ * line2.head<2>().squaredNorm() +
                              weight1_ * line1.head<2>().squaredNorm();
  if (squared_norm < 1e-300) {
    if (jacobian != nullptr) jacobian->setZero();
    return 0;
  }
  const double inverse_norm = 1 / std::sqrt(squared_norm);
  if (jacobian != nullptr) {
    // dr/dE = (x2 - a) x1^T - x2 b^T, a and b from the norm's derivative.
    const double ratio = numerator / squared_norm;
    const Vec3 left(x2[0] - ratio * weight2_ * line2[0],
                    x2[1] - ratio * weight2_ * line2[1], x2[2]);
    const Vec2 right = (ratio * weight1_) * line1.head<2>();
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
  if (indices.size() < 5) return pose;
  double damping = 1e-4;
  NormalEquations system =
      Linearize(pose, pairs, indices, options.loss_scale_px);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    Mat5 damped = system.hessian;
    damped.diagonal() += damping * system.hessian.diagonal();
    const Vec5 step = -damped.ldlt().solve(system.gradient);
    if (!step.allFinite()) break;
    const RigidTransform moved = Moved(pose, step);
    if (Cost(moved, pairs, indices, options.loss_scale_px) <= system.cost) {
      pose = moved;
      damping = std::max(1e-10, damping * 0.1);
      if (step.norm() < 1e-9) break;
      system = Linearize(pose, pairs, indices, options.loss_scale_px);
    } else {
      if (step.norm() < 1e-9) break;
      damping = std::max(1e-6, damping * 10);
      if (damping > 1e6) break;
    }
  }
  pose.rotation = NearestRotation(pose.rotation);
  return pose;
}

std::optional<Mat5> RelativePoseCovariance(const RigidTransform& cam2_from_cam1,
                                           const PointPairs& pairs,
                                           const std::vector<int>& indices,
                                           double loss_scale_px) {
  const double n = static_cast<double>(indices.size());
  if (n < 6) return std::nullopt;
  const SampsonResidual residual(cam2_from_cam1, pairs.focal1_px,
                                 pairs.focal2_px);
  Mat5 information = Mat5::Zero();
  double sum_squared_psi = 0;
  double sum_psi_slope = 0;
  Vec5 jacobian;
  for (const int i : indices) {
    const double r = residual(pairs.x1[i], pairs.x2[i], &jacobian);
    const double squared = (r / loss_scale_px) * (r / loss_scale_px);
    const double weight = 1 / (1 + squared);
    information.noalias() += jacobian * jacobian.transpose();
    sum_squared_psi += weight * r * weight * r;
    sum_psi_slope += (1 - squared) * weight * weight;
  }
  const Eigen::LDLT<Mat5> factor(information);
  const double slope = sum_psi_slope / n;
  if (factor.info() != Eigen::Success || !(slope > 0) ||
      !(factor.vectorD().minCoeff() > 1e-14 * factor.vectorD().maxCoeff())) {
    return std::nullopt;
  }
  const double variance = sum_squared_psi / (n - 5) / (slope * slope);
  const Mat5 covariance = variance * factor.solve(Mat5::Identity());
  return Mat5(0.5 * (covariance + covariance.transpose()));
}

}  // namespace lowlap
