#include "lowlap/scene/internal/align_poses.h"

#include <cmath>

namespace lowlap {
namespace {

constexpr double kAxisOfSpread = 0.1;

double Spread(const std::vector<Pose>& poses) {
  const double weight = 1 / static_cast<double>(poses.size());
  Vec3 mean = Vec3::Zero();
  for (const Pose& pose : poses) mean += weight * pose.center;
  double variance = 0;
  for (const Pose& pose : poses) {
    variance += weight * (pose.center - mean).squaredNorm();
  }
  return variance <= 1e-24 * (1 + mean.squaredNorm()) ? 0 : std::sqrt(variance);
}

std::vector<Vec3> Tips(const std::vector<Pose>& poses, double length) {
  std::vector<Vec3> tips;
  for (const Pose& pose : poses) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 tip = length * pose.rotation.row(axis).transpose();
      tips.emplace_back(pose.center + tip);
      tips.emplace_back(pose.center - tip);
    }
  }
  return tips;
}

}  // namespace

Result<Similarity> AlignPoses(const std::vector<Pose>& source,
                              const std::vector<Pose>& target) {
  const double source_spread = Spread(source), target_spread = Spread(target);
  if (!(source_spread > 0) || !(target_spread > 0)) {
    return MakeError(ErrorCode::kInsufficientData,
                     "alignment needs cameras that are not all in one place");
  }
  return AlignPoints(Tips(source, kAxisOfSpread * source_spread),
                     Tips(target, kAxisOfSpread * target_spread));
}

}  // namespace lowlap
