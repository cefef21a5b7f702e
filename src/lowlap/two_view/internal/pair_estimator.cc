#include "lowlap/two_view/internal/pair_estimator.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/log_combinatorics.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/internal/pixel_unit.h"
#include "lowlap/scene/validation.h"
#include "lowlap/two_view/internal/evidence/rival_motion.h"
#include "lowlap/two_view/internal/evidence/surroundings.h"
#include "lowlap/two_view/internal/search/kept_covariance.h"
#include "lowlap/two_view/internal/search/same_pose.h"

namespace lowlap {
namespace {

// What is rarer is not by chance.
constexpr double kMaxLog10Chance = -3;
// Of a pattern some copies are missed (RepeatedPattern), and agree as well: an
// eighth of the evidence for false poses of equal windows, where a third and
// more of it is left for right ones. What bears out another motion has no more
// than a ninth of the evidence for right poses of photographs.
constexpr double kMinShareOfEvidence = 0.25;

// Adds the matches whose points have none yet.
void AddMatches(const std::vector<FeatureMatch>& extra,
                std::vector<FeatureMatch>* matches) {
  std::set<FeatureIndex> used1, used2;
  for (const FeatureMatch& match : *matches) {
    used1.insert(match.first);
    used2.insert(match.second);
  }
  for (const FeatureMatch& match : extra) {
    if (used1.count(match.first) == 0 && used2.count(match.second) == 0) {
      matches->push_back(match);
    }
  }
  std::sort(matches->begin(), matches->end());
}

// One motion refined; whether it is of one plane may be unknown.
RelativePose ImproveMotion(const TwoViewInput& input, const RelativePose& pose,
                           std::optional<bool> is_of_one_plane,
                           const TwoViewOptions& options,
                           std::vector<FeatureMatch>* lone_matches) {
  RelativePose improved = ImproveRelativePose(
      input, pose, is_of_one_plane.value_or(false), options, lone_matches);
  if (!is_of_one_plane) improved.covariance = KeptCovariance(pose, improved);
  return improved;
}

// The pose and its alternatives refined on the matches of `input`. These may
// have been found with the pose, and draw an alternative over to it: that says
// nothing, and the alternative stays as it was.
RelativePose Improve(const TwoViewInput& input, const RelativePose& pose,
                     std::optional<bool> is_of_one_plane,
                     const TwoViewOptions& options,
                     std::vector<FeatureMatch>* lone_matches) {
  RelativePose improved =
      ImproveMotion(input, pose, is_of_one_plane, options, lone_matches);
  const auto differs = [&](const RelativePose& other) {
    return !SamePose(other.Cam2FromCam1(), improved.Cam2FromCam1());
  };
  std::vector<AlternativeMotion> alternatives;
  for (const AlternativeMotion& other : pose.alternatives) {
    const RelativePose before = pose.WithMotion(other);
    const RelativePose after =
        ImproveMotion(input, before, is_of_one_plane, options, nullptr);
    if (differs(after)) {
      alternatives.push_back(after.AsAlternative());
    } else if (differs(before)) {
      alternatives.push_back(other);
    }
  }
  improved.alternatives = std::move(alternatives);
  return improved;
}

std::vector<FeatureMatch> GuidedLineMatches(
    const ViewMeasurements& first, const ViewMeasurements& second,
    const RigidTransform& cam2_from_cam1,
    const std::vector<FeatureMatch>& seeds, const PairOptions& options) {
  const DetectedFeatures &d1 = *first.detected, &d2 = *second.detected;
  return MatchLinesGuided({d1.features.segments, d1.line_descriptors},
                          {d2.features.segments, d2.line_descriptors},
                          first.features, second.features, cam2_from_cam1,
                          seeds, options.guided_lines);
}

// Matches again under the pose, and refines it on what that finds.
void UseGuidedMatches(const ViewMeasurements& first,
                      const ViewMeasurements& second,
                      const PairOptions& options,
                      const GuidedMatchFilters& filters,
                      std::vector<FeatureMatch>* line_matches,
                      TwoViewInput* input, TwoViewResult* result) {
  RelativePose* const pose = &result->pose;
  const DetectedFeatures &d1 = *first.detected, &d2 = *second.detected;
  input->point_matches = pose->point_inliers;
  if (options.use_points &&
      static_cast<int>(pose->point_inliers.size()) < options.starved_below) {
    const std::vector<FeatureMatch> guided =
        MatchPointsGuided({d1.keypoints, d1.point_descriptors, first.features},
                          {d2.keypoints, d2.point_descriptors, second.features},
                          pose->Cam2FromCam1(), 2 * pose->point_threshold_px,
                          options.guided_points);
    AddMatches(filters.points ? filters.points(guided) : guided,
               &input->point_matches);
  }
  *line_matches = GuidedLineMatches(first, second, pose->Cam2FromCam1(),
                                    *line_matches, options);
  if (filters.lines) *line_matches = filters.lines(*line_matches);
  if (options.use_lines) input->line_matches = *line_matches;
  *pose = Improve(*input, *pose, result->is_of_one_plane, options.two_view,
                  &result->lone_matches);
}

// Whether most of the matches agree that do not repeat, beyond chance.
bool MostOfTheRestAgrees(const std::vector<FeatureMatch>& matches,
                         const std::vector<FeatureMatch>& inliers,
                         const ViewMeasurements& first,
                         const ViewMeasurements& second) {
  const std::set<FeatureMatch> agreeing(inliers.begin(), inliers.end());
  int num = 0, num_agreeing = 0;
  for (const FeatureMatch& match : matches) {
    if (first.repeats.HasPoint(match.first) ||
        second.repeats.HasPoint(match.second)) {
      continue;
    }
    ++num;
    num_agreeing += agreeing.count(match) > 0 ? 1 : 0;
  }
  return Log10BinomialTail(num, num_agreeing, 0.5) < kMaxLog10Chance;
}

// Whether places that look alike, of what is not known to repeat, bear out
// another motion nearly as well.
bool HasRivalMotion(const RelativePose& pose, const ViewMeasurements& first,
                    const ViewMeasurements& second) {
  // Points that were matched elsewhere have no look.
  const auto is_asked = [](const ViewMeasurements& view, FeatureIndex point) {
    return point < view.detected->keypoints.size() &&
           !view.repeats.HasPoint(point);
  };
  std::vector<FeatureMatch> others;
  std::copy_if(pose.point_inliers.begin(), pose.point_inliers.end(),
               std::back_inserter(others), [&](const FeatureMatch& match) {
                 return is_asked(first, match.first) &&
                        is_asked(second, match.second);
               });
  const auto view = [](const ViewMeasurements& of_view) {
    const DetectedFeatures& detected = *of_view.detected;
    return PointView{detected.keypoints, detected.point_descriptors,
                     of_view.features};
  };
  return Log10NfaOfRivalMotion(view(first), view(second), pose, others) <
         kMinShareOfEvidence * pose.log10_nfa;
}

std::optional<PoseWeakness> WeaknessOf(const TwoViewResult& result,
                                       const PairMatches& putative,
                                       const ViewMeasurements& first,
                                       const ViewMeasurements& second) {
  if (!(result.scattered_log10_nfa < 0)) {
    return PoseWeakness::kMatchesSideBySide;
  }
  // Of what is left when all known copies are gone, about half agree with a
  // motion of copies at most: those that were missed.
  if (result.pose.log10_nfa >
          kMinShareOfEvidence * result.log10_nfa_with_repeats &&
      !MostOfTheRestAgrees(putative.points, result.pose.point_inliers, first,
                           second)) {
    return PoseWeakness::kRepeats;
  }
  // Without them, features may be those with matches only.
  const bool has_all = first.detected != nullptr && second.detected != nullptr;
  if (has_all && HasRivalMotion(result.pose, first, second)) {
    return PoseWeakness::kRepeats;
  }
  if (has_all && Log10ChanceOfSurroundings(first.features, second.features,
                                           result.pose) < kMaxLog10Chance) {
    return PoseWeakness::kSurroundings;
  }
  return std::nullopt;
}

}  // namespace

Status PairOptions::Validate() const {
  for (const Status& valid :
       {two_view.Validate(), guided_lines.Validate(), guided_points.Validate(),
        line_filter.Validate()}) {
    if (!valid) return valid;
  }
  if (!use_points && !use_lines) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "relative poses need points or lines");
  }
  return {};
}

ViewMeasurements MeasureView(const ViewFeatures& features,
                             const Intrinsic& intrinsic,
                             const Vec2& image_size_px,
                             const DetectedFeatures* detected,
                             const VanishingOptions& options) {
  ViewMeasurements view;
  view.features = NormalizeFeatures(features, intrinsic);
  view.directions = FindVanishingDirections(view.features, options,
                                            PixelUnit(image_size_px.norm()));
  view.image_size_px = image_size_px;
  view.detected = detected;
  if (detected == nullptr) return view;
  for (const Keypoint& keypoint : detected->keypoints) {
    view.point_covariances.push_back(keypoint.covariance);
  }
  view.repeats = RepeatedPattern::Find(
      {detected->keypoints, detected->point_descriptors, view.features});
  return view;
}

TwoViewInput InputOf(const ViewPair& views, const ViewMeasurements& first,
                     const ViewMeasurements& second) {
  TwoViewInput input;
  input.views = views;
  input.features1 = &first.features;
  input.features2 = &second.features;
  input.directions1 = &first.directions;
  input.directions2 = &second.directions;
  if (!first.point_covariances.empty() && !second.point_covariances.empty()) {
    input.point_covariances1 = &first.point_covariances;
    input.point_covariances2 = &second.point_covariances;
  }
  input.repeats1 = &first.repeats;
  input.repeats2 = &second.repeats;
  input.image_size1_px = first.image_size_px;
  input.image_size2_px = second.image_size_px;
  return input;
}

PairEstimate EstimatePair(const ViewPair& views, const ViewMeasurements& first,
                          const ViewMeasurements& second,
                          const PairMatches& putative,
                          const PairOptions& options, std::uint64_t seed,
                          const GuidedMatchFilters& filters) {
  PairEstimate estimate;
  TwoViewInput input = InputOf(views, first, second);
  if (options.use_points) input.point_matches = putative.points;
  if (options.use_lines) input.line_matches = putative.lines;
  auto result = EstimateRelativePose(input, options.two_view, seed);
  if (!result) {
    estimate.reason = result.error().message;
    return estimate;
  }
  RelativePose& pose = result->pose;
  for (const RelativePose& other : result->alternatives) {
    pose.alternatives.push_back(other.AsAlternative());
  }
  estimate.geometry = result->geometry;
  estimate.log10_nfa = pose.log10_nfa;
  estimate.log10_nfa_with_repeats = result->is_of_unrepeated
                                        ? pose.log10_nfa
                                        : result->log10_nfa_with_repeats;
  estimate.num_point_inliers = static_cast<int>(pose.point_inliers.size());
  if (!result->HasDirection()) {
    estimate.no_parallax = true;
    estimate.reason = Format(
        "no parallax: the views differ by a rotation of %.2f degrees only",
        DegFromRad(RotationAngleBetween(pose.rotation, Mat3::Identity())));
    return estimate;
  }
  std::vector<FeatureMatch> line_matches = putative.lines;
  if (first.detected != nullptr && second.detected != nullptr) {
    UseGuidedMatches(first, second, options, filters, &line_matches, &input,
                     &*result);
  }
  pose.line_inliers =
      FilterLineMatches(line_matches, *input.features1, *input.features2,
                        pose.Cam2FromCam1(), options.line_filter);
  if (pose.covariance) {
    *pose.covariance += SpreadOfRivals(pose.Cam2FromCam1(), result->rivals);
  }
  estimate.num_point_inliers = static_cast<int>(pose.point_inliers.size());
  // One pair that cannot be used must not make the scene invalid.
  if (const Status valid = ValidateRelativePose(pose); !valid) {
    estimate.reason = "the estimate is not usable: " + valid.error().message;
    return estimate;
  }
  pose.weakness = WeaknessOf(*result, putative, first, second);
  estimate.pose = std::move(pose);
  estimate.lone_matches = std::move(result->lone_matches);
  return estimate;
}

PairEstimate TakePair(const ViewPair& views, const ViewMeasurements& first,
                      const ViewMeasurements& second,
                      const PairMatches& matches,
                      const RigidTransform& cam2_from_cam1,
                      const PairOptions& options) {
  RelativePose pose;
  pose.views = views;
  pose.rotation = cam2_from_cam1.rotation;
  pose.direction = cam2_from_cam1.translation.normalized();
  pose.point_inliers = matches.points;
  std::vector<FeatureMatch> line_matches = matches.lines;
  if (first.detected != nullptr && second.detected != nullptr) {
    line_matches = GuidedLineMatches(first, second, pose.Cam2FromCam1(),
                                     line_matches, options);
  }
  pose.line_inliers =
      FilterLineMatches(line_matches, first.features, second.features,
                        pose.Cam2FromCam1(), options.line_filter);
  PairEstimate estimate;
  estimate.num_point_inliers = static_cast<int>(pose.point_inliers.size());
  if (const Status valid = ValidateRelativePose(pose); !valid) {
    estimate.reason = "the given pose is not usable: " + valid.error().message;
    return estimate;
  }
  estimate.pose = std::move(pose);
  return estimate;
}

RelativePose RefinePair(const RelativePose& pose, const ViewMeasurements& first,
                        const ViewMeasurements& second,
                        const PairOptions& options,
                        std::vector<FeatureMatch>* lone_matches) {
  TwoViewInput input = InputOf(pose.views, first, second);
  if (options.use_points) input.point_matches = pose.point_inliers;
  if (options.use_lines) input.line_matches = pose.line_inliers;
  RelativePose refined =
      Improve(input, pose, std::nullopt, options.two_view, lone_matches);
  refined.line_inliers =
      FilterLineMatches(pose.line_inliers, first.features, second.features,
                        refined.Cam2FromCam1(), options.line_filter);
  return ValidateRelativePose(refined) ? refined : pose;
}

}  // namespace lowlap
