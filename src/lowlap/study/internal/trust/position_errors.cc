#include "lowlap/study/internal/trust/position_errors.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace lowlap {
namespace {

double SizeOf(const GroundTruth& truth) {
  double size = 0;
  for (const auto& [view, pose] : truth) {
    for (const auto& [other, of_other] : truth) {
      size = std::max(size, (pose.center - of_other.center).norm());
    }
  }
  return size;
}

struct AlignedErrors {
  double cost = HUGE_VAL;  // the sum of the truncated errors
  double scale = 0;
  std::vector<double> errors;
};

AlignedErrors ErrorsAt(const std::vector<Vec3>& turned,
                       const std::vector<Vec3>& truth, double scale,
                       const Vec3& translation, double wrong) {
  AlignedErrors aligned;
  aligned.cost = 0;
  aligned.scale = scale;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    const double error = (scale * turned[n] + translation - truth[n]).norm();
    aligned.errors.push_back(error);
    aligned.cost += std::min(error, wrong);
  }
  return aligned;
}

// Indices below `count`, at most kMaxTried of them.
std::vector<std::size_t> EvenlySpaced(std::size_t count) {
  constexpr std::size_t kMaxTried = 30;
  const std::size_t num_tried = std::min(count, kMaxTried);
  std::vector<std::size_t> indices;
  for (std::size_t n = 0; n < num_tried; ++n) {
    indices.push_back(n * count / num_tried);
  }
  return indices;
}

}  // namespace

PositionErrors RobustPositionErrors(const Scene& scene,
                                    const GroundTruth& truth, double wrong) {
  std::vector<ViewId> views;
  std::vector<Vec3> solved, true_centers;
  std::vector<Mat3> truth_from_solved;
  for (const auto& [view, pose] : truth) {
    const Pose* found = scene.FindPose(view);
    if (found == nullptr) continue;
    views.push_back(view);
    solved.push_back(found->center);
    true_centers.push_back(pose.center);
    truth_from_solved.emplace_back(pose.rotation.transpose() * found->rotation);
  }
  const double size = SizeOf(truth);
  const std::vector<std::size_t> tried = EvenlySpaced(views.size());
  AlignedErrors best;
  for (const std::size_t n : tried) {
    std::vector<Vec3> turned;
    turned.reserve(solved.size());
    for (const Vec3& center : solved) {
      turned.emplace_back(truth_from_solved[n] * center);
    }
    for (const std::size_t i : tried) {
      for (const std::size_t j : tried) {
        if (j >= i) break;
        const Vec3 step = turned[i] - turned[j];
        const double scale =
            step.dot(true_centers[i] - true_centers[j]) / step.squaredNorm();
        if (!(scale > 0) || !std::isfinite(scale)) continue;
        const Vec3 translation = (true_centers[i] + true_centers[j]) / 2 -
                                 scale * (turned[i] + turned[j]) / 2;
        AlignedErrors aligned =
            ErrorsAt(turned, true_centers, scale, translation, wrong * size);
        if (aligned.cost < best.cost) best = std::move(aligned);
      }
    }
  }
  PositionErrors errors;
  errors.size = size;
  if (size > 0) errors.unit = best.scale / size;
  for (std::size_t n = 0; n < views.size(); ++n) {
    errors.error[views[n]] =
        best.errors.empty() ? HUGE_VAL : best.errors[n] / size;
  }
  return errors;
}

}  // namespace lowlap
