#include "lowlap/pipeline/measure_images.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lowlap/matching/internal/pair_retrieval.h"
#include "lowlap/matching/internal/pair_selection.h"
#include "lowlap/matching/internal/points/subpixel_refinement.h"
#include "lowlap/pipeline/internal/measure/cached_measurements.h"
#include "lowlap/pipeline/internal/measure/image_measurements.h"
#include "lowlap/pipeline/internal/measure/relative_poses.h"
#include "lowlap/pipeline/internal/scene_reduction.h"

namespace lowlap {
namespace {

Status RefinePoints(const std::map<ViewId, DetectedFeatures>& detected,
                    const MeasurementOptions& options,
                    const RunContext& context, Scene* scene) {
  const auto summary =
      RefinePointTracks(detected, options.refinement, context, scene);
  if (!summary) return tl::unexpected<Error>(summary.error());
  context.Log(LogLevel::kInfo,
              "point refinement: " + std::to_string(summary->refined) + " of " +
                  std::to_string(summary->observations) +
                  " observations aligned");
  return RefineRelativePoses(scene, detected, options.relative_poses, context);
}

void UpdateCounts(const Scene& scene, std::vector<PairReport>* reports) {
  for (PairReport& report : *reports) {
    const auto found = scene.relative_poses.find(report.views);
    if (found == scene.relative_poses.end()) continue;
    report.num_point_inliers =
        static_cast<int>(found->second.point_inliers.size());
    report.num_line_inliers =
        static_cast<int>(found->second.line_inliers.size());
  }
}

}  // namespace

Status MeasurementOptions::Validate() const {
  for (const Status& valid :
       {features.Validate(), retrieval.Validate(), matching.Validate(),
        relative_poses.Validate(), refinement.Validate()}) {
    if (!valid) return valid;
  }
  if (!(max_cache_gb >= 0 && std::isfinite(max_cache_gb))) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "max_cache_gb must not be negative");
  }
  return {};
}

Result<ImageMeasurements> MatchImages(const Scene& scene,
                                      const MeasurementOptions& options,
                                      const RunContext& context,
                                      StageLog* stages) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  const bool retrieve = options.pairs == "auto";
  std::vector<ViewPair> pairs;
  if (!retrieve) {  // what can be refused is refused before the long work
    auto selected = SelectViewPairs(scene, options.pairs);
    if (!selected) return tl::unexpected<Error>(selected.error());
    pairs = std::move(*selected);
  }

  std::optional<CacheFolder> cache;
  if (!options.cache_folder.empty()) {
    auto folder = CacheFolder::Open(options.cache_folder);
    if (!folder) return tl::unexpected<Error>(folder.error());
    cache = std::move(*folder);
  }
  KeyedFeatures detected;
  {
    const StageLog::Scope scope(stages, "features");
    if (cache) {
      auto result = DetectFeatures(scene, options.features, *cache, context);
      if (!result) return tl::unexpected<Error>(result.error());
      detected = std::move(*result);
    } else {
      auto result =
          DetectFeatures(scene, options.features, context, &detected.failed);
      if (!result) return tl::unexpected<Error>(result.error());
      detected.features = std::move(*result);
    }
  }
  for (const auto& [view, error] : detected.failed) {
    if (detected.features.size() < 2) return tl::unexpected<Error>(error);
    context.Log(LogLevel::kWarning, "left out: " + error.ToString());
  }
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const ViewPair& pair) {
                               return detected.failed.count(pair.first) > 0 ||
                                      detected.failed.count(pair.second) > 0;
                             }),
              pairs.end());
  if (retrieve) {
    const StageLog::Scope scope(stages, "pair retrieval");
    auto found = RetrievePairs(detected.features, options.retrieval, context);
    if (!found) return tl::unexpected<Error>(found.error());
    pairs = std::move(*found);
  }
  std::map<ViewPair, PairMatches> matches;
  {
    const StageLog::Scope scope(stages, "matching");
    auto result = cache ? MatchFeatures(detected, pairs, options.matching,
                                        *cache, context)
                        : MatchFeatures(detected.features, pairs,
                                        options.matching, context);
    if (!result) return tl::unexpected<Error>(result.error());
    matches = std::move(*result);
    if (cache) cache->Prune(options.max_cache_gb * 1e9);
  }
  return ImageMeasurements{std::move(detected.features), std::move(matches),
                           std::move(detected.failed)};
}

Result<std::vector<PairReport>> RelatePairs(
    const ImageMeasurements& measurements, const MeasurementOptions& options,
    const RunContext& context, StageLog* stages, Scene* scene) {
  for (const auto& [view, features] : measurements.features) {
    scene->features[view] = features.features;
  }
  Result<std::vector<PairReport>> reports;
  {
    const StageLog::Scope scope(stages, "relative poses");
    reports = EstimateRelativePoses(scene, measurements.matches,
                                    &measurements.features,
                                    options.relative_poses, context);
    if (!reports) return reports;
  }
  if (options.refine_points) {
    const StageLog::Scope scope(stages, "point refinement");
    const Status refined =
        RefinePoints(measurements.features, options, context, scene);
    if (!refined) return tl::unexpected<Error>(refined.error());
    UpdateCounts(*scene, &*reports);
  }
  KeepMatchedFeatures(scene);
  return reports;
}

Result<std::vector<PairReport>> MeasureImages(Scene* scene,
                                              const MeasurementOptions& options,
                                              const RunContext& context,
                                              StageLog* stages) {
  const auto measurements = MatchImages(*scene, options, context, stages);
  if (!measurements) return tl::unexpected<Error>(measurements.error());
  return RelatePairs(*measurements, options, context, stages, scene);
}

}  // namespace lowlap
