#include "lowlap/two_view/relative_pose_estimator.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "lowlap/core/random.h"
#include "lowlap/geometry/rotation.h"
#include "lowlap/robust/a_contrario.h"
#include "lowlap/two_view/chance_support.h"
#include "lowlap/two_view/planar_motion.h"
#include "lowlap/two_view/pose_search.h"
#include "lowlap/two_view/refine_relative_pose.h"

namespace lowlap {
namespace {

constexpr int kMinMatches = 6;
/// A plane that holds this share of the inliers is worth a second motion.
constexpr double kPlaneShare = 0.5;
/// Two motions are told apart by an advantage worth ten points that fit one
/// perfectly and the other not at all, 10 log(10): noise alone reaches half.
constexpr double kDecisiveScore = 23;

/// The Sampson distance is the point's distance to its epipolar line divided by
/// the square root of two (equal focal lengths), so that its law is that much
/// steeper. The smaller image, where chance is larger, decides.
BackgroundLaw SampsonLaw(const TwoViewInput& input) {
  BackgroundLaw law;
  for (const Vec2& size : {input.image_size1_px, input.image_size2_px}) {
    law.coefficient = std::max(
        law.coefficient,
        BackgroundLaw::PointToLine(size.prod(), size.norm()).coefficient);
  }
  law.coefficient *= std::sqrt(2.0);
  return law;
}

Status ValidateInput(const TwoViewInput& input) {
  if (input.features1 == nullptr || input.features2 == nullptr) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "relative pose: a view has no features");
  }
  for (const Vec2& size : {input.image_size1_px, input.image_size2_px}) {
    if (!(size.minCoeff() > 0) || !size.allFinite()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "relative pose: an image has no size");
    }
  }
  for (const double focal :
       {input.features1->focal_px, input.features2->focal_px}) {
    if (!(focal > 0) || !std::isfinite(focal)) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "relative pose: a focal length is not positive");
    }
  }
  for (const FeatureMatch& match : input.point_matches) {
    if (match.first >= input.features1->points.size() ||
        match.second >= input.features2->points.size()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "relative pose: match " + std::to_string(match.first) +
                           "-" + std::to_string(match.second) +
                           " refers to a point that does not exist");
    }
  }
  return {};
}

/// The usable matches in random order.
struct ShuffledMatches {
  PointPairs pairs;
  std::vector<int> match_of_pair;  // index into point_matches
};

ShuffledMatches Shuffle(const TwoViewInput& input, Random& random) {
  ShuffledMatches shuffled;
  std::vector<int>& order = shuffled.match_of_pair;
  for (std::size_t m = 0; m < input.point_matches.size(); ++m) {
    const FeatureMatch& match = input.point_matches[m];
    if (input.features1->points[match.first].z() != 0 &&
        input.features2->points[match.second].z() != 0) {
      order.push_back(static_cast<int>(m));
    }
  }
  for (std::size_t n = order.size(); n > 1; --n) {
    std::swap(order[n - 1], order[random.Index(static_cast<std::uint32_t>(n))]);
  }
  shuffled.pairs.focal1_px = input.features1->focal_px;
  shuffled.pairs.focal2_px = input.features2->focal_px;
  for (const int m : order) {
    const FeatureMatch& match = input.point_matches[m];
    shuffled.pairs.x1.push_back(input.features1->points[match.first]);
    shuffled.pairs.x2.push_back(input.features2->points[match.second]);
  }
  return shuffled;
}

std::string Decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", value);
  return text;
}

RelativePose ToRelativePose(const TwoViewInput& input,
                            const ShuffledMatches& matches,
                            const PoseCandidate& candidate) {
  RelativePose pose;
  pose.views = input.views;
  pose.rotation = candidate.pose.rotation;
  pose.direction = candidate.pose.translation;
  std::vector<int> inliers;
  for (const int i : candidate.inliers) {
    inliers.push_back(matches.match_of_pair[i]);
  }
  std::sort(inliers.begin(), inliers.end());
  for (const int m : inliers) {
    pose.point_inliers.push_back(input.point_matches[m]);
  }
  pose.log10_nfa = candidate.score.log10_nfa;
  pose.point_threshold_px = candidate.score.threshold;
  pose.covariance =
      RelativePoseCovariance(candidate.pose, matches.pairs, candidate.inliers,
                             PoseSearch::LossScalePx(candidate));
  return pose;
}

/// To within the convergence of the refinement.
bool SameMotion(const RigidTransform& a, const RigidTransform& b) {
  return RotationAngleBetween(a.rotation, b.rotation) < 1e-4 &&
         AngleBetween(a.translation, b.translation) < 1e-4;
}

std::optional<ScenePlane> DominantPlaneOf(const PoseCandidate& candidate,
                                          const PointPairs& pairs,
                                          Random& random) {
  // Transfer errors have two components, each with the noise of both views.
  return DominantPlane(candidate.pose, pairs, candidate.inliers,
                       3 * candidate.score.threshold, random);
}

/// The other explanation of a scene whose points lie mostly on `plane`.
std::optional<PoseCandidate> PlanarAlternative(const PoseSearch& search,
                                               const PointPairs& pairs,
                                               const PoseCandidate& candidate,
                                               const ScenePlane& plane) {
  if (static_cast<double>(plane.inliers.size()) <
      kPlaneShare * static_cast<double>(candidate.inliers.size())) {
    return std::nullopt;
  }
  const std::optional<RigidTransform> motion = OtherPlanarMotion(
      candidate.pose, plane.normal, pairs.x1[plane.inliers.front()]);
  if (!motion) return std::nullopt;
  PoseCandidate other = search.Finish(*motion);
  if (SameMotion(candidate.pose, other.pose)) return std::nullopt;
  return other;
}

}  // namespace

Status TwoViewOptions::Validate() const {
  if (!(max_threshold_px > PoseSearch::kMinThresholdPx)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "relative pose: max_threshold_px must exceed " +
                         Decimal(PoseSearch::kMinThresholdPx));
  }
  if (max_samples < 1) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "relative pose: max_samples must be positive");
  }
  if (!(confidence > 0 && confidence < 1)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "relative pose: confidence must lie between 0 and 1");
  }
  return {};
}

const char* TwoViewGeometryName(TwoViewGeometry geometry) {
  switch (geometry) {
    case TwoViewGeometry::kGeneral:
      return "general";
    case TwoViewGeometry::kPlanar:
      return "planar";
    case TwoViewGeometry::kAmbiguousPlane:
      return "ambiguous_plane";
    case TwoViewGeometry::kRotationOnly:
      return "rotation_only";
  }
  return "unknown";
}

Result<TwoViewResult> EstimateRelativePose(const TwoViewInput& input,
                                           const TwoViewOptions& options,
                                           std::uint64_t seed) {
  if (Status status = options.Validate(); !status) {
    return tl::unexpected(status.error());
  }
  if (Status status = ValidateInput(input); !status) {
    return tl::unexpected(status.error());
  }
  Random random(seed);
  const ShuffledMatches matches = Shuffle(input, random);
  const PointPairs& pairs = matches.pairs;
  if (pairs.size() < kMinMatches) {
    return MakeError(ErrorCode::kInsufficientData,
                     "relative pose: " + std::to_string(pairs.size()) +
                         " usable point matches, " +
                         std::to_string(kMinMatches) + " needed");
  }
  TwoViewResult result;
  result.num_matches = pairs.size();
  PoseSearch search(pairs, SampsonLaw(input), options);
  std::optional<PoseCandidate> best = search.Search(random, result.num_samples);
  if (!best || !(best->score.log10_nfa < 0)) {
    return MakeError(
        ErrorCode::kInsufficientData,
        "relative pose: no motion explains the " +
            std::to_string(pairs.size()) + " point matches better than chance" +
            (best ? " (log10 NFA " + Decimal(best->score.log10_nfa) + ")"
                  : ""));
  }
  std::optional<ScenePlane> plane = DominantPlaneOf(*best, pairs, random);
  std::optional<PoseCandidate> other;
  if (plane) other = PlanarAlternative(search, pairs, *best, *plane);
  if (other) {
    const double scale_px = PoseSearch::LossScalePx(*best);
    const double advantage = search.CoreScore(best->pose, scale_px) -
                             search.CoreScore(other->pose, scale_px);
    if (advantage < 0) {
      std::swap(*best, *other);
      plane = DominantPlaneOf(*best, pairs, random);
    }
    result.geometry = std::abs(advantage) < kDecisiveScore
                          ? TwoViewGeometry::kAmbiguousPlane
                          : TwoViewGeometry::kPlanar;
  }
  if (plane) {
    result.num_plane_inliers = static_cast<int>(plane->inliers.size());
  }
  const TranslationEvidence translation =
      TestTranslation(pairs, best->pose, best->inliers, best->score.threshold);
  result.num_rotation_inliers = translation.num_rotation_inliers;
  if (!(translation.log10_nfa < 0)) {
    result.geometry = TwoViewGeometry::kRotationOnly;
  }
  result.pose = ToRelativePose(input, matches, *best);
  if (result.geometry == TwoViewGeometry::kAmbiguousPlane) {
    result.alternatives.push_back(ToRelativePose(input, matches, *other));
  }
  return result;
}

}  // namespace lowlap
