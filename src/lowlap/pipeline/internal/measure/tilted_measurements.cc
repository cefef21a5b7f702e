#include "lowlap/pipeline/internal/measure/tilted_measurements.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/image_memory.h"
#include "lowlap/features/internal/points/point_memory.h"
#include "lowlap/features/internal/points/tilted_points.h"
#include "lowlap/matching/internal/points/tilted_matching.h"
#include "lowlap/matching/internal/starved_pairs.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_bytes.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_cache.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_key.h"

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

// The least tilt takes the most memory, turned by 45 degrees.
constexpr double kLargestTilted = 1.5;

// `key` is that of the features, with a cache.
Result<TiltedPoints> DetectInView(const Scene& scene, ViewId view,
                                  const DetectedFeatures& untilted,
                                  const std::optional<Hash128::Value>& key,
                                  const FeatureOptions& options,
                                  const RunContext& context) {
  const std::string path = scene.ImagePath(view);
  LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
  if (key && FeatureKey(bytes, scene.FindIntrinsic(view), options) != *key) {
    return MakeError(ErrorCode::kIo, "the photograph changed during the run",
                     path);
  }
  LOWLAP_ASSIGN_OR_RETURN(const GrayImage image,
                          DecodeImageOfView(scene, view, bytes));
  const double side_px =
      std::min(std::max(image.width, image.height), options.tilts.max_side_px);
  return DetectTiltedPoints(
      image, {untilted.keypoints, untilted.point_descriptors}, options.points,
      options.tilts,
      WithinPointMemory(context, kLargestTilted * side_px * side_px,
                        options.max_memory_gb));
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
    std::optional<Hash128::Value> key;
    if (cache) {
      key = detected.keys.at(view);
      of_view.key = TiltedKey(*key, options.tilts);
    }
    const auto detect = [&] {
      return DetectInView(scene, view, detected.features.at(view), key, options,
                          context);
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
        const ViewId first = pairs[n].first, second = pairs[n].second;
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
