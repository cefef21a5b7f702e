#include "lowlap/pipeline/internal/measure/tilted_measurements.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/image_memory.h"
#include "lowlap/features/internal/points/point_memory.h"
#include "lowlap/features/internal/points/tilted_points.h"
#include "lowlap/matching/internal/points/tilted_matching.h"
#include "lowlap/matching/internal/starved_pairs.h"
#include "lowlap/pipeline/internal/measure/measurement_bytes.h"
#include "lowlap/pipeline/internal/measure/measurement_cache.h"
#include "lowlap/pipeline/internal/measure/measurement_key.h"

namespace lowlap {
namespace {

struct TiltedOfView {
  Hash128::Value key;  // with a cache
  TiltedPoints points;
};

// What a cache holds, or else what `make` makes of it, which is then kept.
template <class Parse, class Make>
auto FindOrMake(std::optional<MeasurementCache>& cache,
                const Hash128::Value& key, const Parse& parse, const Make& make)
    -> decltype(make()) {
  if (!cache) return make();
  if (auto found = cache->Find(key, parse)) return std::move(*found);
  auto made = make();
  if (made) cache->Write(key, ToBytes(*made));
  return made;
}

RunContext WithinMemory(const GrayImage& image, const FeatureOptions& options,
                        const RunContext& context) {
  // The least tilt takes the most, turned by 45 degrees.
  const double side_px =
      std::min(std::max(image.width, image.height), options.tilts.max_side_px);
  const double fit = options.max_memory_gb * 1e9 /
                     (kPointBytesPerPixel * 1.5 * side_px * side_px);
  RunContext limited = context;
  limited.num_threads = static_cast<int>(
      std::clamp(fit, 1.0, static_cast<double>(context.ThreadCount())));
  return limited;
}

// One view after the other, each with all threads.
Result<std::map<ViewId, TiltedOfView>> DetectInViews(
    const std::vector<ViewPair>& pairs, const Scene& scene,
    const KeyedFeatures& detected, const FeatureOptions& options,
    const CacheFolder* cache_folder, const RunContext& context) {
  std::map<ViewId, TiltedOfView> tilted;
  for (const ViewPair& pair : pairs) {
    tilted[pair.first];
    tilted[pair.second];
  }
  std::optional<MeasurementCache> cache;
  if (cache_folder != nullptr) cache.emplace(*cache_folder, "tilted", context);
  const ReusedImageMemory reused_memory;
  for (auto& entry : tilted) {
    const ViewId view = entry.first;
    TiltedOfView& of_view = entry.second;
    if (cache) of_view.key = TiltedKey(detected.keys.at(view), options.tilts);
    const auto detect = [&]() -> Result<TiltedPoints> {
      LOWLAP_ASSIGN_OR_RETURN(const GrayImage image,
                              ReadGrayImage(scene.ImagePath(view)));
      const DetectedFeatures& untilted = detected.features.at(view);
      return DetectTiltedPoints(
          image, {untilted.keypoints, untilted.point_descriptors},
          options.points, options.tilts, WithinMemory(image, options, context));
    };
    LOWLAP_ASSIGN_OR_RETURN(
        of_view.points,
        FindOrMake(cache, of_view.key, TiltedPointsFromBytes, detect));
  }
  return tilted;
}

Status MatchPairs(const std::vector<ViewPair>& pairs,
                  const std::map<ViewId, TiltedOfView>& tilted,
                  const KeyedFeatures& detected, const MatchOptions& options,
                  const CacheFolder* cache_folder, const RunContext& context,
                  std::map<ViewPair, PairMatches>* matches) {
  std::optional<MeasurementCache> cache;
  if (cache_folder != nullptr) {
    cache.emplace(*cache_folder, "tilted_matches", context);
  }
  return ParallelFor(
      context, "matching tilted views", pairs.size(), [&](std::size_t n) {
        const auto& [first, second] = pairs[n];
        const TiltedOfView &tilted1 = tilted.at(first),
                           &tilted2 = tilted.at(second);
        PairMatches& of_pair = matches->at(pairs[n]);
        Hash128::Value key;
        if (cache) {
          key = TiltedMatchKey(tilted1.key, tilted2.key,
                               MatchKey(detected.keys.at(first),
                                        detected.keys.at(second), options),
                               options.tilted_points);
        }
        const auto match = [&]() -> std::optional<PairMatches> {
          return PairMatches{
              MatchTiltedPoints(
                  {detected.features.at(first).keypoints, tilted1.points.looks},
                  {detected.features.at(second).keypoints,
                   tilted2.points.looks},
                  of_pair.points, options.tilted_points),
              of_pair.lines};
        };
        of_pair = *FindOrMake(cache, key, MatchesFromBytes, match);
      });
}

}  // namespace

Status MatchStarvedPairs(const Scene& scene, const MeasurementOptions& options,
                         const CacheFolder* cache, const RunContext& context,
                         KeyedFeatures* detected,
                         std::map<ViewPair, PairMatches>* matches) {
  if (!options.features.detect_points || !options.matching.match_points ||
      options.features.tilts.max_tilt == 1) {
    return {};
  }
  const std::vector<ViewPair> pairs =
      SelectStarvedPairs(*matches, options.matching.tilted_points);
  LOWLAP_ASSIGN_OR_RETURN(
      const auto tilted,
      DetectInViews(pairs, scene, *detected, options.features, cache, context));
  for (const auto& [view, of_view] : tilted) {
    AddPoints(of_view.points.added, &detected->features.at(view));
  }
  return MatchPairs(pairs, tilted, *detected, options.matching, cache, context,
                    matches);
}

}  // namespace lowlap
