#include "lowlap/adjustment/internal/costs/relative_pose_prior.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

const double kRotationFloorRad = RadFromDeg(0.1);
const double kDirectionFloorRad = RadFromDeg(0.3);
const double kMaxRotationRad = RadFromDeg(10);
const double kMaxDirectionRad = RadFromDeg(30);

bool Agrees(const RelativePose& pose, const PoseState& first,
            const PoseState& second) {
  const RigidTransform cam2_from_cam1 =
      second.CamFromWorld() * first.CamFromWorld().Inverse();
  return cam2_from_cam1.translation.norm() > 0 &&
         RotationAngleBetween(pose.rotation, cam2_from_cam1.rotation) <
             kMaxRotationRad &&
         AngleBetween(pose.direction, cam2_from_cam1.translation) <
             kMaxDirectionRad;
}

}  // namespace

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
    if (prior.first == prior.second || !Agrees(pose, cameras.poses[prior.first],
                                               cameras.poses[prior.second])) {
      continue;
    }
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

}  // namespace lowlap
