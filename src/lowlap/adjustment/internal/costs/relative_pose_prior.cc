#include "lowlap/adjustment/internal/costs/relative_pose_prior.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "lowlap/adjustment/internal/costs/jacobian_map.h"
#include "lowlap/adjustment/internal/costs/quaternion.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

const double kRotationFloorRad = RadFromDeg(0.1);
const double kDirectionFloorRad = RadFromDeg(0.3);
const double kMaxRotationRad = RadFromDeg(10);
const double kMaxDirectionRad = RadFromDeg(30);

}  // namespace

bool RelativePoseCost::Evaluate(const double* const* parameters,
                                double* residuals, double** jacobians) const {
  const QuaternionRotation q1(parameters[0]), q2(parameters[2]);
  const Eigen::Map<const Vec3> c1(parameters[1]), c2(parameters[3]);
  // q1* m*, then the error q2 q1* m*.
  const Eigen::Quaterniond inverse_measured =
      measured_.cam2_from_cam1.conjugate();
  const Vec3 m = inverse_measured.vec();
  const double m_w = inverse_measured.w();
  const Vec3 a = q1.w * m - m_w * q1.u - q1.u.cross(m);
  const double a_w = q1.w * m_w + q1.u.dot(m);
  const double sign = q2.w * a_w - q2.u.dot(a) < 0 ? -2 : 2;
  const Mat3 matrix2 = q2.Matrix();
  const Vec3 between = c1 - c2;
  const Vec3 t = matrix2 * between;
  const double length = t.norm();
  if (!(length > 0)) return false;

  using Vec5 = Eigen::Matrix<double, 5, 1>;
  const auto& basis = measured_.tangent_basis;
  const Eigen::Matrix<double, 5, 5>& weight = measured_.sqrt_information;
  Vec5 deviation;
  deviation.head<3>() = sign * (q2.w * a + a_w * q2.u + q2.u.cross(a));
  deviation.tail<2>() = basis.transpose() * t / length;
  Eigen::Map<Vec5> residual(residuals);
  residual = weight * deviation;
  if (jacobians == nullptr) return true;

  const Eigen::Matrix<double, 2, 3> by_t =
      (basis.transpose() - deviation.tail<2>() * t.transpose() / length) /
      length;
  if (jacobians[0] != nullptr) {
    const Mat3 by_a = q2.w * Mat3::Identity() + CrossMatrix(q2.u);
    Eigen::Matrix<double, 3, 4> by_q1;
    by_q1.leftCols<3>() =
        by_a * (CrossMatrix(m) - m_w * Mat3::Identity()) + q2.u * m.transpose();
    by_q1.col(3) = by_a * m + m_w * q2.u;
    JacobianMap<5, 4>(jacobians[0]) = sign * weight.leftCols<3>() * by_q1;
  }
  if (jacobians[2] != nullptr) {
    Eigen::Matrix<double, 5, 4> by_q2;
    by_q2.topLeftCorner<3, 3>() =
        sign * (a_w * Mat3::Identity() - CrossMatrix(a));
    by_q2.topRightCorner<3, 1>() = sign * a;
    by_q2.bottomRows<2>() = by_t * q2.Jacobian(between);
    JacobianMap<5, 4>(jacobians[2]) = weight * by_q2;
  }
  const Eigen::Matrix<double, 5, 3> by_c1 =
      weight.rightCols<2>() * by_t * matrix2;
  if (jacobians[1] != nullptr) JacobianMap<5, 3>(jacobians[1]) = by_c1;
  if (jacobians[3] != nullptr) JacobianMap<5, 3>(jacobians[3]) = -by_c1;
  return true;
}

std::vector<RelativePosePrior> LoadRelativePosePriors(
    const Scene& scene, const CameraSet& cameras) {
  std::vector<RelativePosePrior> priors;
  for (const auto& [views, pose] : scene.relative_poses) {
    const int first = cameras.Find(views.first);
    const int second = cameras.Find(views.second);
    if (!pose.covariance || first < 0 || second < 0) continue;
    RelativePosePrior prior;
    prior.first = cameras.views[first].pose;
    prior.second = cameras.views[second].pose;
    prior.cam2_from_cam1 = pose.Cam2FromCam1();
    if (prior.first == prior.second || !IsKept(prior, cameras)) continue;
    Eigen::Matrix<double, 5, 5> covariance = *pose.covariance;
    covariance.topLeftCorner<3, 3>() +=
        kRotationFloorRad * kRotationFloorRad * Mat3::Identity();
    covariance.bottomRightCorner<2, 2>() +=
        kDirectionFloorRad * kDirectionFloorRad * Mat2::Identity();
    const Eigen::LLT<Eigen::Matrix<double, 5, 5>> factor(covariance);
    if (factor.info() != Eigen::Success) continue;
    prior.measured.cam2_from_cam1 = Eigen::Quaterniond(pose.rotation);
    prior.measured.tangent_basis = TangentBasis(pose.direction);
    prior.measured.sqrt_information =
        factor.matrixL().solve(Eigen::Matrix<double, 5, 5>::Identity());
    priors.push_back(prior);
  }
  return priors;
}

bool IsKept(const RelativePosePrior& prior, const CameraSet& cameras) {
  const RigidTransform cam2_from_cam1 =
      cameras.poses[prior.second].CamFromWorld() *
      cameras.poses[prior.first].CamFromWorld().Inverse();
  return cam2_from_cam1.translation.norm() > 0 &&
         RotationAngleBetween(prior.cam2_from_cam1.rotation,
                              cam2_from_cam1.rotation) < kMaxRotationRad &&
         AngleBetween(prior.cam2_from_cam1.translation,
                      cam2_from_cam1.translation) < kMaxDirectionRad;
}

}  // namespace lowlap
