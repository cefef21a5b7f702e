#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lowlap/two_view/internal/kernels/essential_kernel.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {

/// Direction of the translation under a known rotation, as a kernel of
/// AContrarioRansac: t ~ (R x1_a x x2_a) x (R x1_b x x2_b) of two matches, of
/// the sign that sees both in front. Degenerate: both matches in one epipolar
/// plane, no model.
class TwoPointKernel {
 public:
  using Model = RigidTransform;  // cam2_from_cam1, |t| = 1
  static constexpr int kSampleSize = 2;

  TwoPointKernel(const EssentialKernel& kernel, const Mat3& rotation,
                 const PoseRefinementOptions& refinement)
      : kernel_(kernel), rotation_(rotation), refinement_(refinement) {}

  int NumData() const { return kernel_.NumData(); }
  void Solve(const std::array<int, 2>& sample,
             std::vector<Model>& models) const;
  void SquaredResiduals(const Model& model, int begin, int end,
                        float* squared_px) const {
    kernel_.SquaredResiduals(model, begin, end, squared_px);
  }
  /// All five parameters, with the directions of `refinement`.
  std::optional<Model> Refine(const Model& model, double threshold_px) const;

 private:
  const EssentialKernel& kernel_;
  Mat3 rotation_;
  PoseRefinementOptions refinement_;
};

}  // namespace lowlap
