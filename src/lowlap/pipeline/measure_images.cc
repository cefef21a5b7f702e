#include "lowlap/pipeline/measure_images.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/matching/internal/pair_retrieval.h"
#include "lowlap/matching/internal/pair_selection.h"
#include "lowlap/matching/internal/points/subpixel_refinement.h"
#include "lowlap/pipeline/internal/measure/cache/cached_measurements.h"
#include "lowlap/pipeline/internal/measure/image_measurements.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/internal/measure/relative_poses.h"
#include "lowlap/pipeline/internal/measure/tilted_measurements.h"
#include "lowlap/pipeline/internal/scene_reduction.h"

namespace lowlap {
namespace {

Status RefinePoints(const std::map<ViewId, DetectedFeatures>& detected,
                    const MeasurementOptions& options,
                    const RunContext& context, Scene* scene) {
  LOWLAP_ASSIGN_OR_RETURN(
      const auto summary,
      RefinePointTracks(detected, options.refinement, context, scene));
  context.Log(LogLevel::kInfo,
              "point refinement: " + std::to_string(summary.refined) + " of " +
                  std::to_string(summary.observations) +
                  " observations aligned");
  return RefineRelativePoses(scene, detected, options.relative_poses, context);
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
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  const bool retrieve = options.pairs == "auto";
  std::vector<ViewPair> pairs;
  if (!retrieve) {  // what can be refused is refused before the long work
    LOWLAP_ASSIGN_OR_RETURN(pairs, SelectViewPairs(scene, options.pairs));
  }

  std::optional<CacheFolder> cache;
  if (!options.cache_folder.empty()) {
    LOWLAP_ASSIGN_OR_RETURN(cache, CacheFolder::Open(options.cache_folder));
  }
  KeyedFeatures detected;
  {
    const StageLog::Scope scope(stages, "features");
    if (cache) {
      LOWLAP_ASSIGN_OR_RETURN(
          detected, DetectFeatures(scene, options.features, *cache, context));
    } else {
      LOWLAP_ASSIGN_OR_RETURN(
          detected.features,
          DetectFeatures(scene, options.features, context, &detected.failed));
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
    LOWLAP_ASSIGN_OR_RETURN(
        pairs, RetrievePairs(detected.features, options.retrieval, context));
  }
  std::map<ViewPair, PairMatches> matches;
  {
    const StageLog::Scope scope(stages, "matching");
    LOWLAP_ASSIGN_OR_RETURN(
        matches, cache ? MatchFeatures(detected, pairs, options.matching,
                                       *cache, context)
                       : MatchFeatures(detected.features, pairs,
                                       options.matching, context));
  }
  {
    const StageLog::Scope scope(stages, "tilted views");
    LOWLAP_RETURN_IF_ERROR(MatchStarvedPairs(scene, options,
                                             cache ? &*cache : nullptr, context,
                                             &detected, &matches));
  }
  if (cache) cache->Prune(options.max_cache_gb * 1e9);
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
    LOWLAP_RETURN_IF_ERROR(
        RefinePoints(measurements.features, options, context, scene));
    CountInliers(*scene, &*reports);
  }
  KeepMatchedFeatures(scene);
  return reports;
}

Result<std::vector<PairReport>> MeasureImages(Scene* scene,
                                              const MeasurementOptions& options,
                                              const RunContext& context,
                                              StageLog* stages) {
  LOWLAP_ASSIGN_OR_RETURN(const auto measurements,
                          MatchImages(*scene, options, context, stages));
  return RelatePairs(measurements, options, context, stages, scene);
}

}  // namespace lowlap
