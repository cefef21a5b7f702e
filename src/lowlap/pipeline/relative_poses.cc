#include "lowlap/pipeline/relative_poses.h"

#include <optional>
#include <utility>

#include "lowlap/core/parallel.h"
#include "lowlap/scene/normalized_features.h"

namespace lowlap {
namespace {

struct PairOutcome {
  PairReport report;
  std::optional<RelativePose> pose;
};

PairOutcome SolvePair(const Scene& scene,
                      const std::map<ViewId, NormalizedFeatures>& features,
                      const ViewPair& views, const PairMatches& matches,
                      const RelativePoseOptions& options, std::uint64_t seed) {
  PairOutcome outcome;
  PairReport& report = outcome.report;
  report.views = views;
  report.num_point_matches = static_cast<int>(matches.points.size());
  report.num_line_matches = static_cast<int>(matches.lines.size());

  const auto size_of = [&](ViewId id) {
    const View& view = scene.views.at(id);
    return Vec2(view.width_px, view.height_px);
  };
  TwoViewInput input;
  input.views = views;
  input.features1 = &features.at(views.first);
  input.features2 = &features.at(views.second);
  input.point_matches = matches.points;
  input.image_size1_px = size_of(views.first);
  input.image_size2_px = size_of(views.second);
  auto result = EstimateRelativePose(input, options.two_view, seed);
  if (!result) {
    report.reason = result.error().message;
    return outcome;
  }
  RelativePose& pose = result->pose;
  report.geometry = TwoViewGeometryName(result->geometry);
  report.num_point_inliers = static_cast<int>(pose.point_inliers.size());
  report.log10_nfa = pose.log10_nfa;
  if (!result->HasDirection()) {
    report.reason = "the views differ by a rotation only";
    return outcome;
  }
  pose.line_inliers =
      FilterLineMatches(matches.lines, *input.features1, *input.features2,
                        pose.Cam2FromCam1(), options.line_filter);
  report.num_line_inliers = static_cast<int>(pose.line_inliers.size());
  report.accepted = true;
  outcome.pose = std::move(pose);
  return outcome;
}

}  // namespace

Status RelativePoseOptions::Validate() const {
  for (const Status& valid :
       {two_view.Validate(), line_filter.Validate(), line_tracks.Validate()}) {
    if (!valid) return valid;
  }
  return {};
}

Result<std::vector<PairReport>> EstimateRelativePoses(
    Scene* scene, const std::map<ViewPair, PairMatches>& matches,
    const RelativePoseOptions& options, const RunContext& context) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  std::vector<std::pair<ViewPair, const PairMatches*>> pairs;
  std::map<ViewId, NormalizedFeatures> features;
  for (const auto& [views, pair_matches] : matches) {
    pairs.emplace_back(views, &pair_matches);
    for (const ViewId view : {views.first, views.second}) {
      const Intrinsic* intrinsic = scene->FindIntrinsic(view);
      const auto found = scene->features.find(view);
      if (intrinsic == nullptr || found == scene->features.end()) {
        return MakeError(ErrorCode::kInvalidArgument,
                         "view " + std::to_string(view) +
                             " is matched but has no intrinsic or no features");
      }
      if (features.count(view) == 0) {
        features[view] = NormalizeFeatures(found->second, *intrinsic);
      }
    }
  }

  std::vector<PairOutcome> outcomes(pairs.size());
  const Status done =
      ParallelFor(context, "relative poses", pairs.size(), [&](std::size_t n) {
        // A stream of its own per pair, whatever else is in the run.
        const std::uint64_t pair_seed =
            context.seed * 0x9E3779B97F4A7C15ull +
            (static_cast<std::uint64_t>(pairs[n].first.first) << 32) +
            pairs[n].first.second;
        outcomes[n] = SolvePair(*scene, features, pairs[n].first,
                                *pairs[n].second, options, pair_seed);
      });
  if (!done) return tl::unexpected<Error>(done.error());

  scene->relative_poses.clear();
  std::vector<PairReport> reports;
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

}  // namespace lowlap
