#include "lowlap/pipeline/relative_poses.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/averaging/motion_choice.h"
#include "lowlap/core/format.h"
#include "lowlap/core/parallel.h"
#include "lowlap/geometry/rotation.h"
#include "lowlap/scene/normalized_features.h"
#include "lowlap/scene/validation.h"
#include "lowlap/two_view/pose_search.h"

namespace lowlap {
namespace {

struct PairOutcome {
  PairReport report;
  std::optional<RelativePose> pose;
};

// What all pairs of a view use.
struct ViewMeasurements {
  NormalizedFeatures features;
  std::vector<VanishingDirection> directions;
  std::vector<Mat2> point_covariances;         // empty: unknown
  const DetectedFeatures* detected = nullptr;  // null: matches are all we have
  Vec2 image_size_px = Vec2::Zero();
};

TwoViewInput MakeInput(const ViewPair& views, const ViewMeasurements& first,
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
  input.image_size1_px = first.image_size_px;
  input.image_size2_px = second.image_size_px;
  return input;
}

ViewMeasurements MeasureView(const Scene& scene, ViewId id,
                             const std::map<ViewId, DetectedFeatures>* detected,
                             const VanishingOptions& options) {
  ViewMeasurements view;
  view.features =
      NormalizeFeatures(scene.features.at(id), *scene.FindIntrinsic(id));
  view.directions = FindVanishingDirections(view.features, options);
  view.image_size_px =
      Vec2(scene.views.at(id).width_px, scene.views.at(id).height_px);
  if (detected == nullptr || detected->count(id) == 0) return view;
  view.detected = &detected->at(id);
  for (const Keypoint& keypoint : view.detected->keypoints) {
    view.point_covariances.push_back(keypoint.covariance);
  }
  return view;
}

// Of all views of the pairs.
Result<std::map<ViewId, ViewMeasurements>> MeasureViews(
    const Scene& scene, const std::vector<ViewPair>& pairs,
    const std::map<ViewId, DetectedFeatures>* detected,
    const VanishingOptions& options, const RunContext& context) {
  std::map<ViewId, ViewMeasurements> measurements;
  for (const ViewPair& pair : pairs) {
    measurements[pair.first];
    measurements[pair.second];
  }
  std::vector<ViewId> views;
  for (const auto& entry : measurements) {
    const ViewId view = entry.first;
    if (scene.FindIntrinsic(view) == nullptr ||
        scene.features.count(view) == 0) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "view " + std::to_string(view) +
                           " is matched but has no intrinsic or no features");
    }
    views.push_back(view);
  }
  const Status done = ParallelFor(
      context, "vanishing directions", views.size(), [&](std::size_t n) {
        measurements.at(views[n]) =
            MeasureView(scene, views[n], detected, options);
      });
  if (!done) return tl::unexpected<Error>(done.error());
  return measurements;
}

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

AlternativeMotion MotionOf(const RelativePose& pose) {
  return {pose.rotation, pose.direction, pose.log10_nfa, pose.covariance};
}

// The pose and its alternatives refined on the matches of `input`. These may
// have been found with the pose, and draw an alternative over to it: that says
// nothing, and the alternative stays as it was.
RelativePose Improve(const TwoViewInput& input, const RelativePose& pose,
                     const TwoViewOptions& options) {
  RelativePose improved = ImproveRelativePose(input, pose, options);
  const auto differs = [&](const RelativePose& other) {
    return !SameMotion(other.Cam2FromCam1(), improved.Cam2FromCam1());
  };
  std::vector<AlternativeMotion> alternatives;
  for (std::size_t n = 1; n < NumMotions(pose); ++n) {
    const RelativePose before = WithMotion(pose, n);
    const RelativePose after = ImproveRelativePose(input, before, options);
    if (differs(after)) {
      alternatives.push_back(MotionOf(after));
    } else if (differs(before)) {
      alternatives.push_back(MotionOf(before));
    }
  }
  improved.alternatives = std::move(alternatives);
  return improved;
}

// Matches again under the pose, and refines it on what that finds.
void UseGuidedMatches(const ViewMeasurements& first,
                      const ViewMeasurements& second,
                      const RelativePoseOptions& options,
                      std::vector<FeatureMatch>* line_matches,
                      TwoViewInput* input, RelativePose* pose) {
  const DetectedFeatures &d1 = *first.detected, &d2 = *second.detected;
  input->point_matches = pose->point_inliers;
  if (options.use_points &&
      static_cast<int>(pose->point_inliers.size()) < options.starved_below) {
    const std::vector<FeatureMatch> guided =
        MatchPointsGuided({d1.keypoints, d1.point_descriptors, first.features},
                          {d2.keypoints, d2.point_descriptors, second.features},
                          pose->Cam2FromCam1(), 2 * pose->point_threshold_px,
                          options.guided_points);
    AddMatches(guided, &input->point_matches);
  }
  *line_matches =
      MatchLinesGuided({d1.features.segments, d1.line_descriptors},
                       {d2.features.segments, d2.line_descriptors},
                       first.features, second.features, pose->Cam2FromCam1(),
                       *line_matches, options.guided_lines);
  if (options.use_lines) input->line_matches = *line_matches;
  *pose = Improve(*input, *pose, options.two_view);
}

PairOutcome SolvePair(const ViewPair& views, const ViewMeasurements& first,
                      const ViewMeasurements& second,
                      const PairMatches& matches,
                      const RelativePoseOptions& options, std::uint64_t seed) {
  PairOutcome outcome;
  PairReport& report = outcome.report;
  report.views = views;
  report.num_point_matches = static_cast<int>(matches.points.size());
  report.num_line_matches = static_cast<int>(matches.lines.size());

  TwoViewInput input = MakeInput(views, first, second);
  if (options.use_points) input.point_matches = matches.points;
  if (options.use_lines) input.line_matches = matches.lines;
  auto result = EstimateRelativePose(input, options.two_view, seed);
  if (!result) {
    report.reason = result.error().message;
    return outcome;
  }
  RelativePose& pose = result->pose;
  for (const RelativePose& other : result->alternatives) {
    pose.alternatives.push_back(MotionOf(other));
  }
  report.geometry = TwoViewGeometryName(result->geometry);
  report.log10_nfa = pose.log10_nfa;
  if (!result->HasDirection()) {
    report.num_point_inliers = static_cast<int>(pose.point_inliers.size());
    report.no_parallax = true;
    report.reason = Format(
        "no parallax: the views differ by a rotation of %.2f degrees only",
        DegFromRad(RotationAngleBetween(pose.rotation, Mat3::Identity())));
    return outcome;
  }
  std::vector<FeatureMatch> line_matches = matches.lines;
  if (first.detected != nullptr && second.detected != nullptr) {
    UseGuidedMatches(first, second, options, &line_matches, &input, &pose);
  }
  pose.line_inliers =
      FilterLineMatches(line_matches, *input.features1, *input.features2,
                        pose.Cam2FromCam1(), options.line_filter);
  report.num_point_inliers = static_cast<int>(pose.point_inliers.size());
  report.num_line_inliers = static_cast<int>(pose.line_inliers.size());
  // One pair that cannot be used must not make the scene invalid.
  if (const Status valid = ValidateRelativePose(pose); !valid) {
    report.reason = "the estimate is not usable: " + valid.error().message;
    return outcome;
  }
  report.accepted = true;
  outcome.pose = std::move(pose);
  return outcome;
}

void LogPairsWithoutParallax(const Scene& scene,
                             const std::vector<PairOutcome>& outcomes,
                             const RunContext& context) {
  constexpr int kMaxNamed = 5;
  int count = 0;
  std::string names;
  for (const PairOutcome& outcome : outcomes) {
    if (!outcome.report.no_parallax || ++count > kMaxNamed) continue;
    const ViewPair& views = outcome.report.views;
    names += (count > 1 ? ", " : "") + scene.views.at(views.first).filename +
             " - " + scene.views.at(views.second).filename;
  }
  if (count == 0) return;
  context.Log(LogLevel::kWarning,
              "no parallax in " + std::to_string(count) +
                  (count == 1 ? " pair, which is" : " pairs, which are") +
                  " left out, since views that differ by a rotation only show "
                  "no direction: " +
                  names + (count > kMaxNamed ? ", ..." : ""));
}

}  // namespace

Status RelativePoseOptions::Validate() const {
  for (const Status& valid :
       {two_view.Validate(), guided_lines.Validate(), guided_points.Validate(),
        line_filter.Validate(), line_tracks.Validate()}) {
    if (!valid) return valid;
  }
  if (!use_points && !use_lines) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "relative poses need points or lines");
  }
  return {};
}

Result<std::vector<PairReport>> EstimateRelativePoses(
    Scene* scene, const std::map<ViewPair, PairMatches>& matches,
    const std::map<ViewId, DetectedFeatures>* detected,
    const RelativePoseOptions& options, const RunContext& context) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  std::vector<ViewPair> pairs;
  for (const auto& entry : matches) pairs.push_back(entry.first);
  const auto measurements =
      MeasureViews(*scene, pairs, detected, options.vanishing, context);
  if (!measurements) return tl::unexpected<Error>(measurements.error());

  std::vector<PairOutcome> outcomes(pairs.size());
  const Status done =
      ParallelFor(context, "relative poses", pairs.size(), [&](std::size_t n) {
        // A stream of its own per pair, whatever else is in the run.
        const std::uint64_t pair_seed =
            context.seed * 0x9E3779B97F4A7C15ull +
            (static_cast<std::uint64_t>(pairs[n].first) << 32) +
            pairs[n].second;
        outcomes[n] = SolvePair(pairs[n], measurements->at(pairs[n].first),
                                measurements->at(pairs[n].second),
                                matches.at(pairs[n]), options, pair_seed);
      });
  if (!done) return tl::unexpected<Error>(done.error());

  scene->relative_poses.clear();
  std::vector<PairReport> reports;
  LogPairsWithoutParallax(*scene, outcomes, context);
  for (PairOutcome& outcome : outcomes) {
    if (outcome.pose) {
      scene->relative_poses[outcome.report.views] = std::move(*outcome.pose);
    }
    reports.push_back(std::move(outcome.report));
  }
  scene->point_tracks = BuildPointTracks(*scene);
  scene->line_tracks = BuildLineTracks(*scene, options.line_tracks);
  return reports;
}

Status RefineRelativePoses(Scene* scene,
                           const std::map<ViewId, DetectedFeatures>& detected,
                           const RelativePoseOptions& options,
                           const RunContext& context) {
  if (const Status valid = options.Validate(); !valid) return valid;
  std::vector<RelativePose*> poses;
  std::vector<ViewPair> pairs;
  for (auto& [views, pose] : scene->relative_poses) {
    poses.push_back(&pose);
    pairs.push_back(views);
  }
  const auto measurements =
      MeasureViews(*scene, pairs, &detected, options.vanishing, context);
  if (!measurements) return tl::unexpected<Error>(measurements.error());
  const Status done =
      ParallelFor(context, "relative poses", poses.size(), [&](std::size_t n) {
        RelativePose& pose = *poses[n];
        TwoViewInput input =
            MakeInput(pose.views, measurements->at(pose.views.first),
                      measurements->at(pose.views.second));
        if (options.use_points) input.point_matches = pose.point_inliers;
        if (options.use_lines) input.line_matches = pose.line_inliers;
        const std::vector<FeatureMatch> lines = pose.line_inliers;
        const RelativePose before = pose;
        pose = Improve(input, pose, options.two_view);
        pose.line_inliers =
            FilterLineMatches(lines, *input.features1, *input.features2,
                              pose.Cam2FromCam1(), options.line_filter);
        if (!ValidateRelativePose(pose)) pose = before;
      });
  if (!done) return done;
  scene->point_tracks = BuildPointTracks(*scene);
  scene->line_tracks = BuildLineTracks(*scene, options.line_tracks);
  return {};
}

}  // namespace lowlap
