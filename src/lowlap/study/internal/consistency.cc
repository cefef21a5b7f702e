#include "lowlap/study/internal/consistency.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/adjustment/internal/costs/projection.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

void JudgeDirections(const Scene& scene, const std::set<ViewPair>& outliers,
                     Consistency* consistency) {
  std::vector<double> errors_deg;
  double total_length = 0;
  for (const auto& [views, relative] : scene.relative_poses) {
    const Pose* first = scene.FindPose(views.first);
    const Pose* second = scene.FindPose(views.second);
    if (first == nullptr || second == nullptr || outliers.count(views) > 0) {
      continue;
    }
    const Vec3 baseline_in_second =
        second->rotation * (first->center - second->center);
    total_length += baseline_in_second.norm();
    errors_deg.push_back(
        baseline_in_second.norm() > 0
            ? DegFromRad(AngleBetween(baseline_in_second, relative.direction))
            : 90.0);
  }
  if (!errors_deg.empty()) {
    consistency->mean_baseline =
        total_length / static_cast<double>(errors_deg.size());
  }
  consistency->direction_deg = Summarize(std::move(errors_deg));
}

ErrorStatistics RatioErrors(const Scene& scene,
                            const std::set<ViewPair>& outliers) {
  const auto length = [&](ViewId a, ViewId b) -> std::optional<double> {
    const Pose* first = scene.FindPose(a);
    const Pose* second = scene.FindPose(b);
    if (first == nullptr || second == nullptr ||
        outliers.count({std::min(a, b), std::max(a, b)}) > 0) {
      return std::nullopt;
    }
    const double distance = (first->center - second->center).norm();
    if (!(distance > 0)) return std::nullopt;
    return distance;
  };
  std::vector<double> errors;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    if (ratio.verdict != RatioVerdict::kMeaningful) continue;
    const auto reference = length(ratio.views.first, ratio.views.middle);
    const auto target = length(ratio.views.middle, ratio.views.last);
    if (!reference || !target) continue;
    errors.push_back(
        std::abs(std::log(*target / *reference) - ratio.log_ratio));
  }
  return Summarize(std::move(errors));
}

}  // namespace

Consistency EvaluateConsistency(const Scene& scene,
                                const std::vector<ViewPair>& outliers) {
  const std::set<ViewPair> excluded(outliers.begin(), outliers.end());
  Consistency consistency;
  JudgeDirections(scene, excluded, &consistency);
  consistency.abs_log_ratio = RatioErrors(scene, excluded);
  consistency.num_points = scene.structure.size();
  double sum_of_squares = 0;
  std::size_t count = 0;
  for (const auto& [id, landmark] : scene.structure) {
    for (const PointObservation& seen : landmark.observations) {
      const Pose* pose = scene.FindPose(seen.view);
      const Intrinsic* intrinsic = scene.FindIntrinsic(seen.view);
      if (pose == nullptr || intrinsic == nullptr) continue;
      const auto error_px = ProjectionErrorPx(
          *intrinsic, pose->CamFromWorld() * landmark.position, seen.pixel_px);
      if (!error_px) continue;
      sum_of_squares += error_px->squaredNorm();
      ++count;
    }
  }
  if (count > 0) {
    consistency.reprojection_rmse_px =
        std::sqrt(sum_of_squares / static_cast<double>(count));
  }
  return consistency;
}

}  // namespace lowlap
