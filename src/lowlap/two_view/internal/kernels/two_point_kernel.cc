#include "lowlap/two_view/internal/kernels/two_point_kernel.h"

namespace lowlap {

void TwoPointKernel::Solve(const std::array<int, 2>& sample,
                           std::vector<Model>& models) const {
  const PointPairs& pairs = kernel_.pairs();
  Vec3 normals[2];
  for (int n = 0; n < 2; ++n) {
    normals[n] = (rotation_ * pairs.x1[sample[n]]).cross(pairs.x2[sample[n]]);
  }
  const Vec3 t = normals[0].cross(normals[1]);
  const double norm = t.norm();
  if (!(norm > 1e-12 * normals[0].norm() * normals[1].norm())) return;
  for (const double sign : {1.0, -1.0}) {
    const RigidTransform pose{rotation_, t * (sign / norm)};
    bool visible = true;
    for (const int i : sample) {
      visible = visible && CheckVisibility(pose, pairs.x1[i], pairs.x2[i], 0) !=
                               Visibility::kBehind;
    }
    if (visible) models.push_back(pose);
  }
}

std::optional<RigidTransform> TwoPointKernel::Refine(
    const Model& model, double threshold_px) const {
  PoseRefinementOptions options = refinement_;
  options.loss_scale_px = threshold_px;
  options.max_iterations = 5;
  return RefineRelativePose(model, kernel_.pairs(),
                            kernel_.WithinThreshold(model, 2 * threshold_px),
                            options);
}

}  // namespace lowlap
