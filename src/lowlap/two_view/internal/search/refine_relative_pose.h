#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"
#include "lowlap/two_view/internal/parallel_directions.h"
#include "lowlap/two_view/internal/search/levenberg_marquardt.h"
#include "lowlap/two_view/internal/search/sandwich_covariance.h"

namespace lowlap {

using Mat5 = Eigen::Matrix<double, 5, 5>;
using Vec5 = Eigen::Matrix<double, 5, 1>;

/// The signed Sampson residual of one match in pixels: with E = [t]x R,
///   r = x2^T E x1 / sqrt( l2^T C2 l2 / f2^2 + l1^T C1 l1 / f1^2 ),
///   l2 = (E x1)_12,  l1 = (E^T x2)_12,
/// C the shapes of the points' errors (identity: the usual form),
/// and, if asked for, its derivative by (w, d) in
///   R <- exp([w]x) R,  t <- (t + B d) / |t + B d|,  B = TangentBasis(t).
/// Zero where both points are epipoles.
class SampsonResidual {
 public:
  /// `pairs` must outlive the residual.
  SampsonResidual(const RigidTransform& cam2_from_cam1,
                  const PointPairs& pairs);

  double operator()(int pair, Vec5* jacobian = nullptr) const {
    return Between(pair, pair, jacobian);
  }
  /// Of the first point of one pair and the second point of another.
  double Between(int first, int second, Vec5* jacobian = nullptr) const;

 private:
  const PointPairs& pairs_;
  Mat3 essential_;
  Eigen::Matrix<double, 9, 5> derivative_;  // of E, row-major
  double weight1_;                          // 1 / f1^2
  double weight2_;
};

struct PoseRefinementOptions {
  /// Scale s of the Cauchy loss s^2 / 2 log(1 + r^2 / s^2).
  double loss_scale_px = 1;
  int max_iterations = 20;
  /// Directions that bear on the rotation, each with the loss
  ///   variance c^2 / 2 log(1 + |m|^2 / c^2),  c = 3,
  /// m its residual (DirectionResidual), variance that of the points' core.
  std::vector<DirectionPair> directions;
  double point_variance_px2 = 0;
};

/// The motion (|t| = 1) that minimises the Cauchy loss of the Sampson residuals
/// of the matches named by `indices`: Levenberg-Marquardt on SO(3) x S^2 with
/// iterated reweighting. Returns the start if points and directions give fewer
/// than 5 equations.
RigidTransform RefineRelativePose(const RigidTransform& cam2_from_cam1,
                                  const PointPairs& pairs,
                                  const std::vector<int>& indices,
                                  const PoseRefinementOptions& options);

/// The normal equations of that loss at a pose: sum w J J^T of the matches, w
/// the weights of the loss, and the directions in the same units.
NormalEquations<5> LinearizePose(const RigidTransform& cam2_from_cam1,
                                 const PointPairs& pairs,
                                 const std::vector<int>& indices,
                                 const PoseRefinementOptions& options);

/// The loss alone.
double PoseCost(const RigidTransform& cam2_from_cam1, const PointPairs& pairs,
                const std::vector<int>& indices,
                const PoseRefinementOptions& options);

/// s^2 / 2 log(1 + r^2 / s^2).
double CauchyCost(double residual, double scale);

/// The pose after a step (w, d) as in SampsonResidual.
RigidTransform MovedPose(const RigidTransform& cam2_from_cam1,
                         const Vec5& step);

/// First and second derivative of s^2 / 2 log(1 + |m|^2 / s^2) by m.
template <int R>
struct CauchyDerivatives {
  using Vec = Eigen::Matrix<double, R, 1>;
  using Mat = Eigen::Matrix<double, R, R>;

  CauchyDerivatives(const Vec& m, double scale)
      : weight(1 / (1 + m.squaredNorm() / (scale * scale))),
        gradient(weight * m),
        hessian(weight * Mat::Identity() -
                2 / (scale * scale) * gradient * gradient.transpose()) {}

  double weight;
  Vec gradient;
  Mat hessian;
};

/// Covariance of (w, d) as above at the minimum of the same loss
/// (SandwichCovariance). It covers errors of the points, of neighbours in
/// common; an imperfect calibration adds its own, which thousands of matches do
/// not average down.
/// nullopt: fewer than 6 matches, or a singular system.
std::optional<Mat5> RelativePoseCovariance(
    const RigidTransform& cam2_from_cam1, const PointPairs& pairs,
    const std::vector<int>& indices, const PoseRefinementOptions& options);

/// Adds what the directions say of (w, d), the first of the parameters.
template <int D>
void AddDirections(const RigidTransform& cam2_from_cam1,
                   const PointPairs& pairs,
                   const PoseRefinementOptions& options,
                   SandwichCovariance<D>* sandwich) {
  Eigen::Matrix<double, D, D> hessian = Eigen::Matrix<double, D, D>::Zero();
  hessian.template topLeftCorner<5, 5>() =
      LinearizePose(cam2_from_cam1, pairs, {}, options).hessian;
  sandwich->AddPrior(hessian, options.point_variance_px2 * hessian);
}

}  // namespace lowlap
