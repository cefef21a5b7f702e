#include "lowlap/two_view/internal/relative_pose_estimator.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/two_view/internal/evidence/partial_evidence.h"
#include "lowlap/two_view/internal/evidence/repeat_evidence.h"
#include "lowlap/two_view/internal/evidence/translation_evidence.h"
#include "lowlap/two_view/internal/other_copies.h"
#include "lowlap/two_view/internal/planes/planar_decision.h"
#include "lowlap/two_view/internal/search/pose_from_search.h"
#include "lowlap/two_view/internal/search/pose_search.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"
#include "lowlap/two_view/internal/search/same_pose.h"
#include "lowlap/two_view/internal/shuffled_matches.h"

namespace lowlap {
namespace {

/// In which matches of other copies are left out.
constexpr int kMaxRounds = 3;
/// What does not repeat corrects a motion that explains most of it, and that
/// copies near the epipolar lines have drawn aside, by so much evidence.
constexpr double kDecisiveLog10Nfa = 3;

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
  for (const FeatureMatch& match : input.line_matches) {
    if (match.first >= input.features1->segments.size() ||
        match.second >= input.features2->segments.size()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "relative pose: match " + std::to_string(match.first) +
                           "-" + std::to_string(match.second) +
                           " refers to a segment that does not exist");
    }
  }
  return {};
}

// The other candidates that are meaningful.
std::vector<RivalPose> RivalsOf(const PoseCandidate& best,
                                const std::vector<PoseCandidate>& candidates) {
  std::vector<RivalPose> rivals;
  for (const PoseCandidate& candidate : candidates) {
    if (candidate.IsMeaningful() && !SamePose(candidate.pose, best.pose)) {
      rivals.push_back(
          {candidate.pose, RivalWeight(best.score - candidate.score)});
    }
  }
  return rivals;
}

void RemoveSamePose(const RigidTransform& pose,
                    std::vector<RivalPose>* rivals) {
  rivals->erase(std::remove_if(rivals->begin(), rivals->end(),
                               [&](const RivalPose& rival) {
                                 return SamePose(rival.pose, pose);
                               }),
                rivals->end());
}

// Lets the poses count for what does not repeat (FindEvidenceBeyondRepeats).
Status DiscountRepeats(const TwoViewInput& input,
                       const ShuffledMatches& matches,
                       const TwoViewOptions& options, TwoViewResult* result) {
  const auto evidence =
      FindEvidenceBeyondRepeats(input, matches, result->pose, options);
  if (!evidence) return {};
  const auto is_meaningful = [](double log10_nfa, RelativePose* pose) {
    pose->log10_nfa = std::max(pose->log10_nfa, log10_nfa);
    return pose->log10_nfa < 0;
  };
  if (!is_meaningful(evidence->log10_nfa, &result->pose)) {
    return MakeError(
        ErrorCode::kInsufficientData,
        Format("relative pose: %d of %d points and crossings of lines belong "
               "to a pattern that repeats in its photograph; the others bear "
               "no motion out (log10 NFA %.1f)",
               evidence->num_repeated,
               evidence->num_repeated + evidence->num_others,
               evidence->log10_nfa));
  }
  std::vector<RelativePose> others;
  for (RelativePose& other : result->alternatives) {
    const auto of_other =
        FindEvidenceBeyondRepeats(input, matches, other, options);
    if (is_meaningful(of_other->log10_nfa, &other)) others.push_back(other);
  }
  if (others.size() < result->alternatives.size()) {
    result->geometry = TwoViewGeometry::kPlanar;
  }
  result->alternatives = std::move(others);
  return {};
}

// Of the indices below `count` those that are not in `indices`, ascending.
std::vector<int> TheRest(const std::vector<int>& indices, int count) {
  std::vector<int> rest;
  for (int n = 0; n < count; ++n) {
    if (!std::binary_search(indices.begin(), indices.end(), n)) {
      rest.push_back(n);
    }
  }
  return rest;
}

// An error unless chance does not explain the best candidate.
Status ValidateBest(const std::vector<PoseCandidate>& candidates,
                    const PointPairs& pairs) {
  if (!candidates.empty() && candidates.front().IsMeaningful()) return {};
  return MakeError(
      ErrorCode::kInsufficientData,
      "relative pose: no motion explains the " + std::to_string(pairs.size()) +
          " points and crossings of lines better than chance" +
          (candidates.empty()
               ? ""
               : " (log10 NFA " +
                     Format("%.1f", candidates.front().support.log10_nfa) +
                     ")"));
}

// Of the matches as they are.
Result<TwoViewResult> EstimateFrom(const TwoViewInput& input,
                                   const ShuffledMatches& matches,
                                   const TwoViewOptions& options,
                                   Random& random) {
  const PointPairs& pairs = matches.pairs;
  if (pairs.size() < kMinMatches) {
    return MakeError(ErrorCode::kInsufficientData,
                     "relative pose: " + std::to_string(pairs.size()) +
                         " usable points and crossings of lines, " +
                         std::to_string(kMinMatches) + " needed");
  }
  TwoViewResult result;
  result.num_matches = pairs.size();
  PoseSearch search(pairs, CommonDirections(input, pairs.size()),
                    SampsonLaw(input), options);
  const std::vector<PoseCandidate> candidates =
      search.Search(random, result.num_samples);
  LOWLAP_RETURN_IF_ERROR(ValidateBest(candidates, pairs));
  auto [best, plane, other, geometry] =
      DecidePlanarMotion(search, pairs, candidates.front(), random);
  const TranslationEvidence translation =
      TestTranslation(pairs, best.pose, best.inliers, best.support.threshold,
                      PoseSearch::kMinThresholdPx);
  result.num_rotation_inliers = translation.num_rotation_inliers;
  result.geometry =
      translation.IsSeen() ? geometry : TwoViewGeometry::kRotationOnly;
  if (plane) {
    result.num_plane_inliers = static_cast<int>(plane->inliers.size());
    result.is_of_one_plane = IsOfOnePlane(best, *plane, pairs);
    if (result.is_of_one_plane) search.TieToPlane(*plane, &best);
  }
  result.pose =
      PoseFromSearch(input, matches, search, best, &result.lone_matches);
  result.rivals = RivalsOf(best, candidates);
  if (result.geometry == TwoViewGeometry::kAmbiguousPlane) {
    // What triplets and cycles may decide for does not widen this motion.
    RemoveSamePose(other->pose, &result.rivals);
    result.alternatives.push_back(
        PoseFromSearch(input, matches, search, *other, nullptr));
  }
  return result;
}

std::size_t CountCommon(const std::vector<FeatureMatch>& a,
                        const std::vector<FeatureMatch>& b) {
  const std::set<FeatureMatch> of_a(a.begin(), a.end());
  return static_cast<std::size_t>(std::count_if(
      b.begin(), b.end(),
      [&](const FeatureMatch& match) { return of_a.count(match) > 0; }));
}

// Many copies may agree on a motion of their own. If what does not repeat
// speaks more for another one, that is the result, and `matches` are what does
// not repeat.
void HearWhatDoesNotRepeat(const TwoViewInput& input,
                           const TwoViewOptions& options, Random& random,
                           ShuffledMatches* matches, TwoViewResult* result) {
  const auto others = MatchesBeyondRepeats(input, *matches);
  if (!others) return;
  ShuffledMatches unrepeated = SomeOf(*matches, *others);
  auto other = EstimateFrom(input, unrepeated, options, random);
  if (!other) return;
  const RelativePose &pose = other->pose, &first = result->pose;
  const bool explains_most =
      2 * CountCommon(pose.point_inliers, first.point_inliers) >=
      pose.point_inliers.size();
  if (explains_most && (other->geometry == TwoViewGeometry::kAmbiguousPlane ||
                        SamePose(pose.Cam2FromCam1(), first.Cam2FromCam1()))) {
    return;
  }
  const double margin = explains_most ? kDecisiveLog10Nfa : 0;
  if (pose.log10_nfa + margin >=
      EvidenceOfSome(input, *matches, *others, first, options)) {
    return;
  }
  other->log10_nfa_with_repeats = result->log10_nfa_with_repeats;
  other->is_of_unrepeated = !explains_most;
  *result = *std::move(other);
  *matches = std::move(unrepeated);
}

}  // namespace

Status TwoViewOptions::Validate() const {
  if (!(max_threshold_px > PoseSearch::kMinThresholdPx)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "relative pose: max_threshold_px must exceed " +
                         Format("%.1f", PoseSearch::kMinThresholdPx));
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
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_RETURN_IF_ERROR(ValidateInput(input));
  Random random(seed);
  ShuffledMatches matches = ShuffleMatches(input, random);
  auto result = EstimateFrom(input, matches, options, random);
  // A better pose sees more of them.
  for (int round = 0; result && round < kMaxRounds; ++round) {
    const std::vector<int> others =
        MatchesOfOtherCopies(input, matches, result->pose, random);
    if (others.empty()) break;
    matches = SomeOf(matches, TheRest(others, matches.pairs.size()));
    result = EstimateFrom(input, matches, options, random);
  }
  if (result) {
    result->log10_nfa_with_repeats = result->pose.log10_nfa;
    HearWhatDoesNotRepeat(input, options, random, &matches, &*result);
  }
  if (result && result->HasDirection()) {
    result->scattered_log10_nfa =
        ScatteredEvidence(input, matches, result->pose, options);
    LOWLAP_RETURN_IF_ERROR(DiscountRepeats(input, matches, options, &*result));
  }
  return result;
}

RelativePose ImproveRelativePose(const TwoViewInput& input,
                                 const RelativePose& pose, bool is_of_one_plane,
                                 const TwoViewOptions& options,
                                 std::vector<FeatureMatch>* lone_matches) {
  // No sample is drawn; the order only matters to the background of chance.
  Random random(0);
  const ShuffledMatches matches = ShuffleMatches(input, random);
  if (matches.pairs.size() < kMinMatches) return pose;
  const PoseSearch search(
      matches.pairs,
      CommonDirections(input, static_cast<int>(matches.pairs.size())),
      SampsonLaw(input), BoundedByPose(options, input, pose));
  PoseCandidate candidate = search.Finish(pose.Cam2FromCam1());
  if (!std::isfinite(candidate.support.log10_nfa)) return pose;
  if (is_of_one_plane) {
    const auto plane = DominantPlaneOf(candidate, matches.pairs, random);
    if (plane) search.TieToPlane(*plane, &candidate);
  }
  RelativePose improved =
      PoseFromSearch(input, matches, search, candidate, lone_matches);
  improved.log10_nfa = pose.log10_nfa;
  improved.weakness = pose.weakness;
  return improved;
}

}  // namespace lowlap
