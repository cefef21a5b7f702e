#include "lowlap/two_view/internal/kernels/essential_kernel.h"

#include <algorithm>
#include <cmath>

#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/two_view/internal/kernels/five_point.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {

EssentialKernel::EssentialKernel(const PointPairs& pairs) : pairs_(pairs) {
  for (int i = 0; i < pairs.size(); ++i) {
    x1_.push_back(static_cast<float>(pairs.x1[i].x()));
    y1_.push_back(static_cast<float>(pairs.x1[i].y()));
    x2_.push_back(static_cast<float>(pairs.x2[i].x()));
    y2_.push_back(static_cast<float>(pairs.x2[i].y()));
    const Mat2 c1 = pairs.Covariance1(i) / (pairs.focal1_px * pairs.focal1_px);
    const Mat2 c2 = pairs.Covariance2(i) / (pairs.focal2_px * pairs.focal2_px);
    xx1_.push_back(static_cast<float>(c1(0, 0)));
    xy1_.push_back(static_cast<float>(2 * c1(0, 1)));
    yy1_.push_back(static_cast<float>(c1(1, 1)));
    xx2_.push_back(static_cast<float>(c2(0, 0)));
    xy2_.push_back(static_cast<float>(2 * c2(0, 1)));
    yy2_.push_back(static_cast<float>(c2(1, 1)));
  }
}

void EssentialKernel::Solve(const std::array<int, 5>& sample,
                            std::vector<Model>& models) const {
  FivePoints x1;
  FivePoints x2;
  for (int n = 0; n < 5; ++n) {
    x1[n] = pairs_.x1[sample[n]];
    x2[n] = pairs_.x2[sample[n]];
  }
  for (const Mat3& essential : EssentialFromFivePoints(x1, x2)) {
    for (const RigidTransform& pose : PosesFromEssential(essential)) {
      bool visible = true;
      for (int n = 0; n < 5 && visible; ++n) {
        visible = CheckVisibility(pose, x1[n], x2[n], 0) != Visibility::kBehind;
      }
      if (visible) models.push_back(pose);
    }
  }
}

void EssentialKernel::SquaredResiduals(const Model& model, int begin, int end,
                                       float* squared_px) const {
  const Eigen::Matrix3f e = EssentialFromPose(model).cast<float>();
  const float e00 = e(0, 0), e01 = e(0, 1), e02 = e(0, 2);
  const float e10 = e(1, 0), e11 = e(1, 1), e12 = e(1, 2);
  const float e20 = e(2, 0), e21 = e(2, 1), e22 = e(2, 2);
  for (int i = begin; i < end; ++i) {
    const float x1 = x1_[i], y1 = y1_[i], x2 = x2_[i], y2 = y2_[i];
    const float line2_x = e00 * x1 + e01 * y1 + e02;
    const float line2_y = e10 * x1 + e11 * y1 + e12;
    const float line2_z = e20 * x1 + e21 * y1 + e22;
    const float line1_x = e00 * x2 + e10 * y2 + e20;
    const float line1_y = e01 * x2 + e11 * y2 + e21;
    const float numerator = x2 * line2_x + y2 * line2_y + line2_z;
    const float squared_norm =
        xx2_[i] * line2_x * line2_x + xy2_[i] * line2_x * line2_y +
        yy2_[i] * line2_y * line2_y + xx1_[i] * line1_x * line1_x +
        xy1_[i] * line1_x * line1_y + yy1_[i] * line1_y * line1_y + 1e-30f;
    squared_px[i] = numerator * numerator / squared_norm;
  }
}

std::vector<int> EssentialKernel::WithinThreshold(const Model& model,
                                                  double threshold_px) const {
  std::vector<float> squared(NumData());
  SquaredResiduals(model, 0, NumData(), squared.data());
  const float limit = static_cast<float>(threshold_px * threshold_px);
  std::vector<int> indices;
  for (int i = 0; i < NumData(); ++i) {
    if (squared[i] <= limit) indices.push_back(i);
  }
  return indices;
}

std::vector<int> EssentialKernel::VisibleWithinThreshold(
    const Model& model, double threshold_px) const {
  std::vector<int> indices = WithinThreshold(model, threshold_px);
  const double noise_rad = NoiseAngle(pairs_, threshold_px);
  const auto behind = [&](int i) {
    return CheckVisibility(model, pairs_.x1[i], pairs_.x2[i], noise_rad) ==
           Visibility::kBehind;
  };
  indices.erase(std::remove_if(indices.begin(), indices.end(), behind),
                indices.end());
  return indices;
}

std::optional<RigidTransform> EssentialKernel::Refine(
    const Model& model, double threshold_px) const {
  PoseRefinementOptions options;
  options.loss_scale_px = threshold_px;
  options.max_iterations = 5;
  return RefineRelativePose(model, pairs_,
                            WithinThreshold(model, 2 * threshold_px), options);
}

double NoiseAngle(const PointPairs& pairs, double threshold_px) {
  return 2 * threshold_px / std::min(pairs.focal1_px, pairs.focal2_px);
}

Visibility CheckVisibility(const RigidTransform& cam2_from_cam1, const Vec3& x1,
                           const Vec3& x2, double min_parallax_rad) {
  // depth1 p + t = depth2 x2, p = R x1; cross products remove one depth each.
  const Vec3 p = cam2_from_cam1.rotation * x1;
  const Vec3& t = cam2_from_cam1.translation;
  const Vec3 normal = p.cross(x2);
  if (normal.squaredNorm() <= min_parallax_rad * min_parallax_rad *
                                  p.squaredNorm() * x2.squaredNorm()) {
    return Visibility::kUndetermined;
  }
  const bool in_front =
      x2.cross(t).dot(normal) > 0 && p.cross(t).dot(normal) > 0;
  return in_front ? Visibility::kInFront : Visibility::kBehind;
}

}  // namespace lowlap
