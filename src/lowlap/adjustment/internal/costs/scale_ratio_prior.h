#pragma once

#include <ceres/sized_cost_function.h>

#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"

namespace lowlap {

/// How far three centres are from a measured scale ratio, in standard
/// deviations (1):
///   r = (log(|C3 - C2| / |C2 - C1|) - log_ratio) / stddev.
/// Parameter blocks: the centres of first, middle and last. Evaluation fails
/// where the middle one is one of the others.
class ScaleRatioCost final : public ceres::SizedCostFunction<1, 3, 3, 3> {
 public:
  ScaleRatioCost(double log_ratio, double log_ratio_stddev)
      : log_ratio_(log_ratio), weight_(1 / log_ratio_stddev) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double log_ratio_;
  double weight_;
};

/// A measured scale ratio of three poses of the set.
struct ScaleRatioPrior {
  int first = -1;  // indices into CameraSet::poses
  int middle = -1;
  int last = -1;
  double log_ratio = 0;
  double log_ratio_stddev = 0;
};

/// The scale ratios of the scene that the poses agree with to within a factor
/// of two (the others are false, or not what placed the poses). Where nothing
/// of the structure carries the scale on, they do: it must not go wherever a
/// false match pulls. To the stated deviation come 2 %, which no number of
/// features averages out, and 10 % where chance explains the ratio as well.
std::vector<ScaleRatioPrior> LoadScaleRatioPriors(const Scene& scene,
                                                  const CameraSet& cameras);

}  // namespace lowlap
