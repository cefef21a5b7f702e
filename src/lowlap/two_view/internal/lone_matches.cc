#include "lowlap/two_view/internal/lone_matches.h"

#include <Eigen/Cholesky>

namespace lowlap {
namespace {

constexpr double kMaxLeverage = 0.5;
constexpr std::size_t kFewestMatches = 6;

}  // namespace

std::vector<double> Leverages(const RigidTransform& cam2_from_cam1,
                              const PointPairs& pairs,
                              const std::vector<int>& indices,
                              const PoseRefinementOptions& options) {
  const Eigen::LDLT<Mat5> factor(
      LinearizePose(cam2_from_cam1, pairs, indices, options).hessian);
  if (!IsWellDetermined(factor)) return {};
  const SampsonResidual residual(cam2_from_cam1, pairs);
  std::vector<double> leverages;
  Vec5 jacobian;
  for (const int i : indices) {
    const double ratio = residual(i, &jacobian) / options.loss_scale_px;
    leverages.push_back(jacobian.dot(factor.solve(jacobian)) /
                        (1 + ratio * ratio));
  }
  return leverages;
}

std::vector<int> BorneOutMatches(const RigidTransform& cam2_from_cam1,
                                 const PointPairs& pairs,
                                 const std::vector<int>& indices,
                                 const PoseRefinementOptions& options) {
  const std::vector<double> leverages =
      Leverages(cam2_from_cam1, pairs, indices, options);
  std::vector<int> rest;
  for (std::size_t n = 0; n < leverages.size(); ++n) {
    if (leverages[n] <= kMaxLeverage) rest.push_back(indices[n]);
  }
  return rest.size() < kFewestMatches ? indices : rest;
}

}  // namespace lowlap
