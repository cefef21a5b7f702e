#include "lowlap/evaluation/internal/relative_errors.h"

#include <cmath>
#include <utility>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

const Pose* Find(const GroundTruth& truth, ViewId view) {
  const auto found = truth.find(view);
  return found == truth.end() ? nullptr : &found->second;
}

}  // namespace

RelativePoseEvaluation EvaluateRelativePoses(const Scene& scene,
                                             const GroundTruth& truth) {
  RelativePoseEvaluation result;
  std::vector<double> rotation_errors, direction_errors;
  for (const auto& [views, relative] : scene.relative_poses) {
    const Pose* first = Find(truth, views.first);
    const Pose* second = Find(truth, views.second);
    if (!first || !second) {
      ++result.num_without_truth;
      continue;
    }
    RelativePoseError error;
    error.views = views;
    error.rotation_error_deg = DegFromRad(RotationAngleBetween(
        relative.rotation, second->rotation * first->rotation.transpose()));
    rotation_errors.push_back(error.rotation_error_deg);
    // The difference of the centres, not of the translations: it stays
    // accurate far from the origin of the world.
    const Vec3 baseline = second->rotation * (first->center - second->center);
    if (baseline.norm() > 0) {
      error.direction_error_deg =
          DegFromRad(AngleBetween(relative.direction, baseline));
      direction_errors.push_back(*error.direction_error_deg);
    }
    result.pairs.push_back(error);
  }
  result.rotation_deg = Summarize(std::move(rotation_errors));
  result.direction_deg = Summarize(std::move(direction_errors));
  return result;
}

ScaleRatioEvaluation EvaluateScaleRatios(const Scene& scene,
                                         const GroundTruth& truth) {
  ScaleRatioEvaluation result;
  std::vector<double> errors;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    if (ratio.verdict == RatioVerdict::kNoCandidates) {
      ++result.num_no_candidates;
      continue;
    }
    const Pose* first = Find(truth, ratio.views.first);
    const Pose* middle = Find(truth, ratio.views.middle);
    const Pose* last = Find(truth, ratio.views.last);
    double length_before = 0, length_after = 0;
    if (first && middle && last) {
      length_before = (middle->center - first->center).norm();
      length_after = (last->center - middle->center).norm();
    }
    if (!(length_before > 0 && length_after > 0)) {
      ++result.num_without_truth;
      continue;
    }
    ScaleRatioError error;
    error.views = ratio.views;
    error.verdict = ratio.verdict;
    error.true_log_ratio = std::log(length_after / length_before);
    error.log_error = ratio.log_ratio - error.true_log_ratio;
    error.stddev = ratio.log_ratio_stddev;
    if (ratio.verdict == RatioVerdict::kMeaningful) {
      errors.push_back(std::abs(error.log_error));
    }
    result.ratios.push_back(error);
  }
  result.abs_log_error = Summarize(std::move(errors));
  return result;
}

}  // namespace lowlap
