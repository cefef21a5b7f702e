#include "lowlap/two_view/pose_search.h"

#include <algorithm>
#include <cmath>

#include "lowlap/geometry/epipolar.h"
#include "lowlap/geometry/rotation.h"
#include "lowlap/robust/a_contrario_ransac.h"
#include "lowlap/two_view/chance_support.h"
#include "lowlap/two_view/five_point.h"
#include "lowlap/two_view/refine_relative_pose.h"
#include "lowlap/two_view/sharpen_pose.h"

namespace lowlap {

PoseSearch::PoseSearch(const PointPairs& pairs, const BackgroundLaw& law,
                       const TwoViewOptions& options)
    : kernel_(pairs),
      law_(law),
      options_(options),
      max_threshold_px_(options.max_threshold_px) {}

AContrarioLadder PoseSearch::Ladder(double max_threshold_px) const {
  return AContrarioLadder(kernel_.NumData(), EssentialKernel::kSampleSize,
                          EssentialKernel::kMaxModels, law_, kMinThresholdPx,
                          max_threshold_px);
}

std::optional<PoseCandidate> PoseSearch::Search(Random& random,
                                                int& num_samples) {
  const AContrarioLadder ladder = Ladder(options_.max_threshold_px);
  AContrarioRansacOptions ransac;
  ransac.max_samples = options_.max_samples;
  ransac.confidence = options_.confidence;
  const auto found = AContrarioRansac(kernel_, ladder, ransac, random);
  num_samples = found.num_samples;
  if (!found.model) return std::nullopt;
  const SharpenedPose sharp =
      SharpenPose(kernel_, *found.model, found.score.threshold, random);
  // Wide enough for the tail of the precision found, not for repetitions.
  max_threshold_px_ = std::min(options_.max_threshold_px, 10 * sharp.scale_px);
  return Finish(sharp.cam2_from_cam1);
}

RigidTransform PoseSearch::WithMostVisible(
    const RigidTransform& cam2_from_cam1) const {
  const auto num_visible = [&](const RigidTransform& pose) {
    return kernel_.VisibleWithinThreshold(pose, max_threshold_px_).size();
  };
  RigidTransform best = cam2_from_cam1;
  std::size_t most = num_visible(best);
  for (const RigidTransform& pose :
       PosesFromEssential(EssentialFromPose(cam2_from_cam1))) {
    const std::size_t count = num_visible(pose);
    if (count > most) {
      most = count;
      best = pose;
    }
  }
  return best;
}

PoseCandidate PoseSearch::Finish(const RigidTransform& cam2_from_cam1) const {
  const AContrarioLadder ladder = Ladder(max_threshold_px_);
  PoseCandidate candidate;
  candidate.pose = WithMostVisible(cam2_from_cam1);
  for (int round = 0; round < 6; ++round) {
    candidate.score = ScoreAgainstChance(kernel_, ladder, candidate.pose);
    PoseRefinementOptions refinement;
    refinement.loss_scale_px = LossScalePx(candidate);
    const RigidTransform refined =
        RefineRelativePose(candidate.pose, kernel_.pairs(),
                           kernel_.VisibleWithinThreshold(
                               candidate.pose, 2 * candidate.score.threshold),
                           refinement);
    const double change =
        RotationAngleBetween(refined.rotation, candidate.pose.rotation) +
        AngleBetween(refined.translation, candidate.pose.translation);
    candidate.pose = refined;
    if (change < 1e-9) break;
  }
  candidate.score = ScoreAgainstChance(kernel_, ladder, candidate.pose);
  candidate.inliers =
      kernel_.VisibleWithinThreshold(candidate.pose, candidate.score.threshold);
  return candidate;
}

double PoseSearch::CoreScore(const RigidTransform& cam2_from_cam1,
                             double scale_px) const {
  const PointPairs& pairs = kernel_.pairs();
  const SampsonResidual residual(cam2_from_cam1, pairs.focal1_px,
                                 pairs.focal2_px);
  double score = 0;
  for (const int i :
       kernel_.VisibleWithinThreshold(cam2_from_cam1, 3 * scale_px)) {
    const double ratio = residual(pairs.x1[i], pairs.x2[i]) / scale_px;
    score += std::log(10 / (1 + std::min(ratio * ratio, 9.0)));
  }
  return score;
}

}  // namespace lowlap
