#include "lowlap/two_view/internal/planes/refine_on_plane.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/two_view/internal/planes/transfer_residual.h"
#include "lowlap/two_view/internal/search/levenberg_marquardt.h"

namespace lowlap {
namespace {

constexpr int kMaxIterations = 50;

struct PlanarMotion {
  RigidTransform cam2_from_cam1;
  Vec3 normal = Vec3::Zero();
};

class PlanarProblem {
 public:
  using State = PlanarMotion;

  PlanarProblem(const PointPairs& pairs, const std::vector<int>& indices,
                const PoseRefinementOptions& options,
                const std::vector<int>& on_plane)
      : pairs_(pairs), options_(options), on_plane_(on_plane) {
    std::set_difference(indices.begin(), indices.end(), on_plane.begin(),
                        on_plane.end(), std::back_inserter(off_plane_));
  }

  NormalEquations<8> Linearize(const PlanarMotion& motion) const {
    const NormalEquations<5> off =
        LinearizePose(motion.cam2_from_cam1, pairs_, off_plane_, options_);
    NormalEquations<8> system;
    system.hessian.topLeftCorner<5, 5>() = off.hessian;
    system.gradient.head<5>() = off.gradient;
    system.cost = off.cost;
    const TransferResidual residual(motion.cam2_from_cam1, motion.normal,
                                    pairs_);
    TransferResidual::Jacobian jacobian;
    for (const int i : on_plane_) {
      const std::optional<Vec2> m = residual(i, &jacobian);
      system.cost += Loss(m);
      if (!m) continue;
      const double weight =
          1 / (1 + m->squaredNorm() / std::pow(options_.loss_scale_px, 2));
      system.hessian.noalias() += weight * jacobian.transpose() * jacobian;
      system.gradient += weight * jacobian.transpose() * *m;
    }
    return system;
  }

  double Cost(const PlanarMotion& motion) const {
    double cost = PoseCost(motion.cam2_from_cam1, pairs_, off_plane_, options_);
    const TransferResidual residual(motion.cam2_from_cam1, motion.normal,
                                    pairs_);
    for (const int i : on_plane_) cost += Loss(residual(i));
    return cost;
  }

  static PlanarMotion Moved(const PlanarMotion& motion,
                            const Eigen::Matrix<double, 8, 1>& step) {
    return {MovedPose(motion.cam2_from_cam1, step.head<5>()),
            motion.normal + step.tail<3>()};
  }

 private:
  // A plane behind a camera explains nothing.
  double Loss(const std::optional<Vec2>& m) const {
    constexpr double kFar = 1e6;
    return CauchyCost(m ? m->norm() : kFar, options_.loss_scale_px);
  }

  const PointPairs& pairs_;
  const PoseRefinementOptions& options_;
  const std::vector<int>& on_plane_;
  std::vector<int> off_plane_;
};

}  // namespace

RigidTransform RefineOnPlane(const RigidTransform& cam2_from_cam1,
                             const PointPairs& pairs,
                             const std::vector<int>& indices,
                             const PoseRefinementOptions& options,
                             ScenePlane* plane) {
  const PlanarProblem problem(pairs, indices, options, plane->inliers);
  PlanarMotion motion = MinimizeLevenbergMarquardt(
      problem, PlanarMotion{cam2_from_cam1, plane->normal}, kMaxIterations);
  motion.cam2_from_cam1.rotation =
      NearestRotation(motion.cam2_from_cam1.rotation);
  plane->normal = motion.normal;
  return motion.cam2_from_cam1;
}

std::optional<Mat5> CovarianceOnPlane(const RigidTransform& cam2_from_cam1,
                                      const PointPairs& pairs,
                                      const ScenePlane& plane,
                                      const PoseRefinementOptions& options) {
  const TransferResidual residual(cam2_from_cam1, plane.normal, pairs);
  // Independent errors: with cells a false motion of one plane states so much
  // that rotation averaging cannot tell it from a right one.
  SandwichCovariance<8> sandwich(0);
  TransferResidual::Jacobian jacobian;
  for (const int i : plane.inliers) {
    const std::optional<Vec2> m = residual(i, &jacobian);
    if (!m) continue;
    const CauchyDerivatives<2> loss(*m, options.loss_scale_px);
    sandwich.Add<2>(pairs.x1[i].head<2>(), jacobian, loss.gradient,
                    loss.hessian);
  }
  AddDirections(cam2_from_cam1, pairs, options, &sandwich);
  const auto covariance = sandwich.Solve();
  if (!covariance) return std::nullopt;
  return Mat5(covariance->topLeftCorner<5, 5>());
}

}  // namespace lowlap
