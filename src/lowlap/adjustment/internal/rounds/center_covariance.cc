#include "lowlap/adjustment/internal/rounds/center_covariance.h"

#include <Eigen/Core>

#include "lowlap/adjustment/internal/rounds/linearised_problem.h"

namespace lowlap {
namespace {

using MatX = Eigen::MatrixXd;

// From the tangent space of the block to its three numbers.
MatX TangentToAmbient(const ceres::Problem& problem, double* block) {
  const ceres::Manifold* manifold = problem.GetManifold(block);
  if (manifold == nullptr) return Mat3::Identity();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      jacobian(3, manifold->TangentSize());
  manifold->PlusJacobian(block, jacobian.data());
  return jacobian;
}

}  // namespace

std::map<PoseId, Mat3> CenterCovariances(
    const std::vector<Component>& components,
    const std::vector<PoseState>& saved_references, const CameraSet& cameras,
    ProblemBuilder* builder) {
  const ceres::Problem& problem = builder->problem();
  const LinearisedProblem linearised(builder);
  if (linearised.kept_size == 0) return {};
  const MatX covariance = PseudoInverse(MatX(linearised.schur_complement));
  std::map<PoseId, Mat3> result;
  for (std::size_t n = 0; n < components.size(); ++n) {
    const Component& component = components[n];
    const double unit = component.baseline > 0 ? component.baseline : 1;
    const Mat3 world_from_frame =
        saved_references[n].cam_from_world.toRotationMatrix().transpose();
    for (const int pose : component.poses) {
      double* center = builder->CenterBlock(pose);
      const int column = linearised.KeptColumn(center);
      if (column < 0) continue;
      const int size = problem.ParameterBlockTangentSize(center);
      const MatX to_world =
          unit * world_from_frame * TangentToAmbient(problem, center);
      result[cameras.poses[pose].id] =
          to_world * covariance.block(column, column, size, size) *
          to_world.transpose();
    }
  }
  return result;
}

}  // namespace lowlap
