#include "lowlap/pipeline/internal/measure/relative_poses.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/pipeline/internal/measure/contradicted_matches.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/internal/measure/weak_poses.h"

namespace lowlap {
namespace {

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
    const char* missing = scene.FindIntrinsic(view) == nullptr ? "intrinsic"
                          : scene.features.count(view) == 0    ? "features"
                                                               : nullptr;
    if (missing != nullptr) {
      return MakeError(ErrorCode::kInvalidArgument,
                       scene.NameOf(view) + " (view " +
                           std::to_string(view.value()) +
                           ") is matched but has no " + missing);
    }
    views.push_back(view);
  }
  const Status done = ParallelFor(
      context, "vanishing directions", views.size(), [&](std::size_t n) {
        const DetectedFeatures* of_view =
            detected != nullptr && detected->count(views[n]) > 0
                ? &detected->at(views[n])
                : nullptr;
        measurements.at(views[n]) = MeasureView(
            scene.features.at(views[n]), *scene.FindIntrinsic(views[n]),
            Vec2(scene.views.at(views[n]).width_px,
                 scene.views.at(views[n]).height_px),
            of_view, options);
      });
  if (!done) return tl::unexpected<Error>(done.error());
  return measurements;
}

// Says in the scene what repeats, as far as the detectors told.
void TakeRepeats(const std::map<ViewId, ViewMeasurements>& measurements,
                 Scene* scene) {
  for (const auto& [id, view] : measurements) {
    if (view.detected == nullptr) continue;
    ViewFeatures& features = scene->features.at(id);
    features.repeated_points.clear();
    features.repeated_segments.clear();
    for (FeatureIndex n = 0; n < view.features.points.size(); ++n) {
      if (view.repeats.HasPoint(n)) features.repeated_points.push_back(n);
    }
    for (FeatureIndex n = 0; n < view.features.segments.size(); ++n) {
      if (view.repeats.HasSegment(view.features.segments[n])) {
        features.repeated_segments.push_back(n);
      }
    }
  }
}

PairReport Report(const ViewPair& views, const PairMatches& matches,
                  const PairEstimate& estimate) {
  PairReport report;
  report.views = views;
  report.accepted = estimate.pose.has_value();
  report.no_parallax = estimate.no_parallax;
  report.reason = estimate.reason;
  if (estimate.geometry) {
    report.geometry = TwoViewGeometryName(*estimate.geometry);
  }
  report.num_point_matches = static_cast<int>(matches.points.size());
  report.num_line_matches = static_cast<int>(matches.lines.size());
  report.num_point_inliers = estimate.num_point_inliers;
  if (estimate.pose) {
    report.num_line_inliers =
        static_cast<int>(estimate.pose->line_inliers.size());
  }
  report.log10_nfa = estimate.log10_nfa;
  return report;
}

void LogPairsWithoutParallax(const Scene& scene,
                             const std::vector<PairReport>& reports,
                             const RunContext& context) {
  constexpr int kMaxNamed = 5;
  int count = 0;
  std::string names;
  for (const PairReport& report : reports) {
    if (!report.no_parallax || ++count > kMaxNamed) continue;
    const ViewPair& views = report.views;
    names += (count > 1 ? ", " : "") + scene.NameOf(views.first) + " - " +
             scene.NameOf(views.second);
  }
  if (count == 0) return;
  context.Log(LogLevel::kWarning,
              "no parallax in " + std::to_string(count) +
                  (count == 1 ? " pair, which is" : " pairs, which are") +
                  " left out, since views that differ by a rotation only show "
                  "no direction: " +
                  names + (count > kMaxNamed ? ", ..." : ""));
}

// Pairs whose poses stand on matches that those of other pairs contradict.
Status EstimateAgainWithoutCopies(
    const Scene& scene, const std::vector<ViewPair>& pairs,
    const std::map<ViewPair, PairMatches>& matches,
    const std::map<ViewId, ViewMeasurements>& measurements,
    const RelativePoseOptions& options, const RunContext& context,
    std::vector<PairEstimate>* estimates) {
  const LoopFindings findings = ExamineLoops(scene, pairs, matches, *estimates);
  std::vector<std::size_t> again;
  for (const auto& entry : findings.allowed) again.push_back(entry.first);
  return ParallelFor(
      context, "relative poses without copies", again.size(),
      [&](std::size_t k) {
        const ViewPair& pair = pairs[again[k]];
        // Matching again under the pose finds the copies again.
        GuidedMatchFilters filters;
        filters.points = [&](const std::vector<FeatureMatch>& points) {
          return WithoutContradicted(points,
                                     findings.loops.OfPoints(pair, points));
        };
        filters.lines = [&](const std::vector<FeatureMatch>& lines) {
          return WithoutContradicted(lines,
                                     findings.loops.OfLines(pair, lines));
        };
        PairEstimate& estimate = (*estimates)[again[k]];
        estimate = EstimatePair(pair, measurements.at(pair.first),
                                measurements.at(pair.second),
                                findings.allowed.at(again[k]), options.pair,
                                PairSeed(context.seed, pair), filters);
        if (!estimate.pose) {
          estimate.reason =
              "without matches that lead elsewhere than those of other "
              "pairs: " +
              estimate.reason;
        }
      });
}

using MatchesOfPairs = std::map<ViewPair, std::vector<FeatureMatch>>;

// The tracks of the relative poses' inliers. Matches that hold a relative pose
// alone are none unless a third view bears them out.
void BuildTracks(const MatchesOfPairs& lone_matches,
                 const RelativePoseOptions& options, Scene* scene) {
  scene->point_tracks = BuildPointTracks(*scene);
  std::set<Track> of_two_views;
  for (const auto& entry : scene->point_tracks) {
    if (entry.second.size() == 2) of_two_views.insert(entry.second);
  }
  bool is_changed = false;
  for (const auto& entry : lone_matches) {
    const auto& [first, second] = entry.first;
    const std::vector<FeatureMatch>& lone = entry.second;
    const auto is_left_out = [&, first = first,
                              second = second](const FeatureMatch& match) {
      return std::find(lone.begin(), lone.end(), match) != lone.end() &&
             of_two_views.count(
                 {{first, match.first}, {second, match.second}}) > 0;
    };
    auto& inliers = scene->relative_poses.at(entry.first).point_inliers;
    const auto end =
        std::remove_if(inliers.begin(), inliers.end(), is_left_out);
    is_changed = is_changed || end != inliers.end();
    inliers.erase(end, inliers.end());
  }
  if (is_changed) scene->point_tracks = BuildPointTracks(*scene);
  scene->line_tracks = BuildLineTracks(*scene, options.line_tracks);
}

}  // namespace

Status RelativePoseOptions::Validate() const {
  LOWLAP_RETURN_IF_ERROR(pair.Validate());
  return line_tracks.Validate();
}

Result<std::vector<PairReport>> EstimateRelativePoses(
    Scene* scene, const std::map<ViewPair, PairMatches>& matches,
    const std::map<ViewId, DetectedFeatures>* detected,
    const RelativePoseOptions& options, const RunContext& context,
    const std::map<ViewPair, RigidTransform>& given) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::vector<ViewPair> pairs;
  pairs.reserve(matches.size());
  for (const auto& entry : matches) pairs.push_back(entry.first);
  LOWLAP_ASSIGN_OR_RETURN(
      const auto measurements,
      MeasureViews(*scene, pairs, detected, options.vanishing, context));
  TakeRepeats(measurements, scene);

  std::vector<PairEstimate> estimates(pairs.size());
  const Status done =
      ParallelFor(context, "relative poses", pairs.size(), [&](std::size_t n) {
        const ViewMeasurements& first = measurements.at(pairs[n].first);
        const ViewMeasurements& second = measurements.at(pairs[n].second);
        const auto known = given.find(pairs[n]);
        estimates[n] =
            known != given.end()
                ? TakePair(pairs[n], first, second, matches.at(pairs[n]),
                           known->second, options.pair)
                : EstimatePair(pairs[n], first, second, matches.at(pairs[n]),
                               options.pair, PairSeed(context.seed, pairs[n]));
      });
  if (!done) return tl::unexpected<Error>(done.error());

  std::vector<ViewPair> unrelated;
  for (const ViewPair& pair : scene->unrelated_pairs) {
    if (matches.count(pair) == 0) unrelated.push_back(pair);
  }
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (!estimates[n].geometry && given.count(pairs[n]) == 0) {
      unrelated.push_back(pairs[n]);
    }
  }
  std::sort(unrelated.begin(), unrelated.end());
  LOWLAP_RETURN_IF_ERROR(EstimateAgainWithoutCopies(
      *scene, pairs, matches, measurements, options, context, &estimates));
  DropWeakPoses(&estimates);
  scene->relative_poses.clear();
  scene->unrelated_pairs = std::move(unrelated);
  std::vector<PairReport> reports;
  MatchesOfPairs lone_matches;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    reports.push_back(Report(pairs[n], matches.at(pairs[n]), estimates[n]));
    if (estimates[n].pose) {
      scene->relative_poses[pairs[n]] = std::move(*estimates[n].pose);
      lone_matches[pairs[n]] = std::move(estimates[n].lone_matches);
    }
  }
  LogPairsWithoutParallax(*scene, reports, context);
  BuildTracks(lone_matches, options, scene);
  CountInliers(*scene, &reports);
  return reports;
}

Status RefineRelativePoses(Scene* scene,
                           const std::map<ViewId, DetectedFeatures>& detected,
                           const RelativePoseOptions& options,
                           const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::vector<RelativePose*> poses;
  std::vector<ViewPair> pairs;
  for (auto& [views, pose] : scene->relative_poses) {
    poses.push_back(&pose);
    pairs.push_back(views);
  }
  LOWLAP_ASSIGN_OR_RETURN(
      const auto measurements,
      MeasureViews(*scene, pairs, &detected, options.vanishing, context));
  std::vector<std::vector<FeatureMatch>> lone(poses.size());
  const Status done =
      ParallelFor(context, "relative poses", poses.size(), [&](std::size_t n) {
        RelativePose& pose = *poses[n];
        pose = RefinePair(pose, measurements.at(pose.views.first),
                          measurements.at(pose.views.second), options.pair,
                          &lone[n]);
      });
  if (!done) return done;
  MatchesOfPairs lone_matches;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    lone_matches[pairs[n]] = std::move(lone[n]);
  }
  BuildTracks(lone_matches, options, scene);
  return {};
}

}  // namespace lowlap
