#include "lowlap/two_view/internal/informed_pose.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/two_view/internal/search/pose_from_search.h"
#include "lowlap/two_view/internal/search/pose_search.h"
#include "lowlap/two_view/internal/shuffled_matches.h"

namespace lowlap {
namespace {

/// All three axes together.
constexpr double kPriorDigits = 3;

// A rotation turns each axis of camera 1 to where the prior has it. Two of the
// three see a turn about any axis.
std::vector<DirectionPair> AxesOf(const RotationPrior& prior) {
  std::vector<DirectionPair> axes;
  for (int k = 0; k < 3; ++k) {
    DirectionPair axis;
    axis.direction1 = Vec3::Unit(k);
    axis.direction2 = prior.cam2_from_cam1.col(k);
    axis.covariance2 =
        2 * prior.stddev_rad * prior.stddev_rad * Mat3::Identity();
    axis.agreement_digits = kPriorDigits / 3;
    axes.push_back(axis);
  }
  return axes;
}

}  // namespace

double PriorPenalty(const RotationPrior& prior, const Mat3& rotation) {
  return DirectionPenalty(AxesOf(prior), rotation);
}

InformedPose InformPose(const TwoViewInput& input, const RelativePose& pose,
                        const RotationPrior& prior, std::uint64_t seed) {
  InformedPose result;
  result.pose = pose;
  Random random(seed);
  const ShuffledMatches matches = ShuffleMatches(input, random);
  if (matches.pairs.size() < kMinMatches) return result;
  std::vector<DirectionPair> directions =
      CommonDirections(input, matches.pairs.size());
  const std::vector<DirectionPair> axes = AxesOf(prior);
  directions.insert(directions.end(), axes.begin(), axes.end());
  const PoseSearch search(matches.pairs, std::move(directions),
                          SampsonLaw(input), BoundedByPose({}, input, pose));
  const double before = search.ScoreOf(pose.Cam2FromCam1());
  PoseCandidate best = search.Finish(pose.Cam2FromCam1());
  int num_samples = 0;
  if (const auto motion = search.MotionWithRotation(prior.cam2_from_cam1,
                                                    random, num_samples)) {
    PoseCandidate other = search.Finish(*motion);
    if (IsBetter(other, best)) best = std::move(other);
  }
  // Wrong matches allow any motion, also that of the prior.
  if (!best.IsMeaningful() || !(best.score > before)) {
    return result;
  }
  result.gained_digits = best.score - before;
  result.prior_digits = PriorPenalty(prior, pose.rotation) -
                        PriorPenalty(prior, best.pose.rotation);
  result.pose = PoseFromSearch(input, matches, search, best, nullptr);
  result.pose.log10_nfa = pose.log10_nfa;
  result.pose.weakness = pose.weakness;
  result.pose.line_inliers = pose.line_inliers;
  return result;
}

}  // namespace lowlap
