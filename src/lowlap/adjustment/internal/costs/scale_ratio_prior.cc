#include "lowlap/adjustment/internal/costs/scale_ratio_prior.h"

#include <cmath>

#include "lowlap/adjustment/internal/costs/jacobian_map.h"

namespace lowlap {
namespace {

constexpr double kFloor = 0.02;
constexpr double kFloorOfChance = 0.1;
const double kMaxDifference = std::log(2.0);

}  // namespace

bool ScaleRatioCost::Evaluate(const double* const* parameters,
                              double* residuals, double** jacobians) const {
  const Eigen::Map<const Vec3> c1(parameters[0]), c2(parameters[1]),
      c3(parameters[2]);
  const Vec3 before = c2 - c1, after = c3 - c2;
  const double before_squared = before.squaredNorm();
  const double after_squared = after.squaredNorm();
  if (!(before_squared > 0) || !(after_squared > 0)) return false;
  residuals[0] =
      weight_ * (0.5 * std::log(after_squared / before_squared) - log_ratio_);
  if (jacobians == nullptr) return true;
  const Eigen::RowVector3d by_first = weight_ / before_squared * before;
  const Eigen::RowVector3d by_last = weight_ / after_squared * after;
  if (jacobians[0] != nullptr) JacobianMap<1, 3>(jacobians[0]) = by_first;
  if (jacobians[1] != nullptr) {
    JacobianMap<1, 3>(jacobians[1]) = -by_first - by_last;
  }
  if (jacobians[2] != nullptr) JacobianMap<1, 3>(jacobians[2]) = by_last;
  return true;
}

std::vector<ScaleRatioPrior> LoadScaleRatioPriors(const Scene& scene,
                                                  const CameraSet& cameras) {
  std::vector<ScaleRatioPrior> priors;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    const int first = cameras.Find(ratio.views.first);
    const int middle = cameras.Find(ratio.views.middle);
    const int last = cameras.Find(ratio.views.last);
    if (first < 0 || middle < 0 || last < 0 || !(ratio.log_ratio_stddev > 0)) {
      continue;
    }
    ScaleRatioPrior prior{cameras.views[first].pose, cameras.views[middle].pose,
                          cameras.views[last].pose, ratio.log_ratio,
                          std::hypot(ratio.log_ratio_stddev, kFloor)};
    if (ratio.verdict != RatioVerdict::kMeaningful) {
      prior.log_ratio_stddev =
          std::hypot(prior.log_ratio_stddev, kFloorOfChance);
    }
    // Views of a rig may share a pose.
    if (prior.first == prior.middle || prior.middle == prior.last ||
        prior.first == prior.last) {
      continue;
    }
    const auto center = [&](int pose) { return cameras.poses[pose].center; };
    const double log_ratio =
        std::log((center(prior.last) - center(prior.middle)).norm() /
                 (center(prior.middle) - center(prior.first)).norm());
    if (std::abs(log_ratio - ratio.log_ratio) < kMaxDifference) {
      priors.push_back(prior);
    }
  }
  return priors;
}

}  // namespace lowlap
