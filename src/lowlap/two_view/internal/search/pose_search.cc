#include "lowlap/two_view/internal/search/pose_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/a_contrario_ransac.h"
#include "lowlap/robust/internal/cauchy_scale.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/two_view/internal/kernels/five_point.h"
#include "lowlap/two_view/internal/kernels/two_point_kernel.h"
#include "lowlap/two_view/internal/lone_matches.h"
#include "lowlap/two_view/internal/planes/refine_on_plane.h"
#include "lowlap/two_view/internal/search/chance_support.h"
#include "lowlap/two_view/internal/search/same_pose.h"
#include "lowlap/two_view/internal/search/sharpen_pose.h"

namespace lowlap {
namespace {

// Rotations from directions that are tried; the others contradict more of the
// directions than these.
constexpr std::size_t kMaxRotations = 8;
constexpr int kMaxRounds = 12;
// The loss is this much wider than the Cauchy density of the residuals: normal
// errors would like it 3.5 times as wide (95 % efficiency at 2.385 deviations),
// outliers narrower.
constexpr double kLossWidth = 1.5;

template <class Kernel>
AContrarioLadder MakeLadder(const Kernel& kernel, int max_models,
                            const BackgroundLaw& law, double max_threshold_px) {
  return AContrarioLadder(kernel.NumData(), Kernel::kSampleSize, max_models,
                          law, PoseSearch::kMinThresholdPx, max_threshold_px);
}

}  // namespace

bool IsBetter(const PoseCandidate& a, const PoseCandidate& b) {
  return a.IsMeaningful() != b.IsMeaningful() ? a.IsMeaningful()
                                              : a.score > b.score;
}

PoseSearch::PoseSearch(const PointPairs& pairs,
                       std::vector<DirectionPair> directions,
                       const BackgroundLaw& law, const TwoViewOptions& options)
    : kernel_(pairs),
      directions_(std::move(directions)),
      law_(law),
      options_(options),
      max_threshold_px_(options.max_threshold_px),
      core_scale_px_(0.1 * options.max_threshold_px) {}

std::vector<PoseCandidate> PoseSearch::Search(Random& random,
                                              int& num_samples) {
  std::vector<RigidTransform> motions = FivePointMotions(random, num_samples);
  std::vector<Mat3> rotations = RotationsFromDirections(directions_);
  if (rotations.size() > kMaxRotations) rotations.resize(kMaxRotations);
  for (const Mat3& rotation : rotations) {
    if (auto motion = MotionWithRotation(rotation, random, num_samples)) {
      motions.push_back(*motion);
    }
  }
  std::vector<PoseCandidate> candidates;
  candidates.reserve(motions.size());
  for (const RigidTransform& motion : motions) {
    candidates.push_back(Finish(motion));
  }
  std::stable_sort(candidates.begin(), candidates.end(), IsBetter);
  std::vector<PoseCandidate> distinct;
  for (PoseCandidate& candidate : candidates) {
    const bool is_known = std::any_of(
        distinct.begin(), distinct.end(), [&](const PoseCandidate& better) {
          return SamePose(candidate.pose, better.pose);
        });
    if (!is_known) distinct.push_back(std::move(candidate));
  }
  return distinct;
}

std::vector<RigidTransform> PoseSearch::FivePointMotions(Random& random,
                                                         int& num_samples) {
  const AContrarioLadder ladder = MakeLadder(
      kernel_, EssentialKernel::kMaxModels, law_, options_.max_threshold_px);
  AContrarioRansacOptions ransac;
  ransac.max_samples = options_.max_samples;
  ransac.confidence = options_.confidence;
  const auto found = AContrarioRansac(kernel_, ladder, ransac, random);
  num_samples += found.num_samples;
  if (!found.model) return {};
  SharpenedPoses sharp =
      SharpenPose(kernel_, *found.model, found.score.threshold, random);
  // Wide enough for the tail of the precision found, not for repetitions.
  max_threshold_px_ = std::min(options_.max_threshold_px, 10 * sharp.scale_px);
  core_scale_px_ = sharp.scale_px;
  return std::move(sharp.cam2_from_cam1);
}

std::optional<RigidTransform> PoseSearch::MotionWithRotation(
    const Mat3& rotation, Random& random, int& num_samples) const {
  PoseRefinementOptions refinement;
  refinement.directions = directions_;
  refinement.point_variance_px2 = 1;
  const TwoPointKernel kernel(kernel_, rotation, refinement);
  const AContrarioLadder ladder =
      MakeLadder(kernel, 1, law_, options_.max_threshold_px);
  AContrarioRansacOptions ransac;
  ransac.max_samples = 1000;
  ransac.confidence = options_.confidence;
  const auto found = AContrarioRansac(kernel, ladder, ransac, random);
  num_samples += found.num_samples;
  return found.model;
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

double PoseSearch::NoiseScalePx(const RigidTransform& cam2_from_cam1,
                                const std::vector<int>& visible) const {
  if (visible.size() < EssentialKernel::kSampleSize) return core_scale_px_;
  const SampsonResidual residual(cam2_from_cam1, kernel_.pairs());
  std::vector<double> errors_px;
  errors_px.reserve(visible.size());
  for (const int i : visible) errors_px.push_back(std::abs(residual(i)));
  const double scale_px =
      TruncatedCauchyScale(Median(std::move(errors_px)), max_threshold_px_);
  return std::clamp(scale_px, 0.5 * kMinThresholdPx, 0.5 * max_threshold_px_);
}

PoseRefinementOptions PoseSearch::RefinementOptions(
    const PoseCandidate& candidate) const {
  PoseRefinementOptions options;
  options.loss_scale_px = candidate.loss_scale_px;
  options.directions = directions_;
  const double stddev_px = std::max(
      kMinThresholdPx, candidate.loss_scale_px / kLossWidth / kMedianOfNorm<1>);
  options.point_variance_px2 = stddev_px * stddev_px;
  return options;
}

AContrarioScore PoseSearch::SupportOf(
    const RigidTransform& cam2_from_cam1) const {
  return ScoreAgainstChance(
      kernel_,
      MakeLadder(kernel_, EssentialKernel::kMaxModels, law_, max_threshold_px_),
      cam2_from_cam1);
}

PoseCandidate PoseSearch::Finish(const RigidTransform& cam2_from_cam1) const {
  PoseCandidate candidate;
  candidate.pose = WithMostVisible(cam2_from_cam1);
  for (int round = 0; round < kMaxRounds; ++round) {
    const std::vector<int> visible =
        kernel_.VisibleWithinThreshold(candidate.pose, max_threshold_px_);
    candidate.loss_scale_px = (round == 0 ? 2 : 1) * kLossWidth *
                              NoiseScalePx(candidate.pose, visible);
    const RigidTransform refined = RefineRelativePose(
        candidate.pose, kernel_.pairs(), visible, RefinementOptions(candidate));
    const double change =
        RotationAngleBetween(refined.rotation, candidate.pose.rotation) +
        AngleBetween(refined.translation, candidate.pose.translation);
    candidate.pose = refined;
    if (round > 0 && change < 1e-9) break;
  }
  candidate.support = SupportOf(candidate.pose);
  candidate.inliers = kernel_.VisibleWithinThreshold(
      candidate.pose, candidate.support.threshold);
  candidate.direction_penalty =
      DirectionPenalty(directions_, candidate.pose.rotation);
  candidate.score = ScoreOf(candidate.pose);
  return candidate;
}

void PoseSearch::TieToPlane(const ScenePlane& plane,
                            PoseCandidate* candidate) const {
  const double threshold_px = candidate->support.threshold;
  const PoseRefinementOptions refinement = RefinementOptions(*candidate);
  // What lies off the plane alone is there by chance.
  const std::vector<int> borne_out = BorneOutMatches(
      candidate->pose, kernel_.pairs(),
      kernel_.VisibleWithinThreshold(candidate->pose, 2 * threshold_px),
      refinement);
  ScenePlane refined_plane = plane;
  const RigidTransform refined = RefineOnPlane(
      candidate->pose, kernel_.pairs(), borne_out, refinement, &refined_plane);
  candidate->plane = plane;
  if (!(SupportOf(refined).log10_nfa < 0)) return;
  candidate->pose = refined;
  candidate->plane = std::move(refined_plane);
  candidate->inliers = kernel_.VisibleWithinThreshold(refined, threshold_px);
}

double PoseSearch::ScoreOf(const RigidTransform& cam2_from_cam1) const {
  const std::vector<double> scores = CoreScores(cam2_from_cam1, core_scale_px_);
  return std::accumulate(scores.begin(), scores.end(), 0.0) / std::log(10.0) -
         DirectionPenalty(directions_, cam2_from_cam1.rotation);
}

std::vector<double> PoseSearch::CoreScores(const RigidTransform& cam2_from_cam1,
                                           double scale_px) const {
  const PointPairs& pairs = kernel_.pairs();
  const SampsonResidual residual(cam2_from_cam1, pairs);
  std::vector<double> scores(static_cast<std::size_t>(pairs.size()));
  for (const int i :
       kernel_.VisibleWithinThreshold(cam2_from_cam1, 3 * scale_px)) {
    const double ratio = residual(i) / scale_px;
    scores[i] = std::log(10 / (1 + std::min(ratio * ratio, 9.0)));
  }
  return scores;
}

}  // namespace lowlap
