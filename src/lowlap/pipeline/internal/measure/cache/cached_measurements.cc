#include "lowlap/pipeline/internal/measure/cache/cached_measurements.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/image_memory.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_bytes.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_cache.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_key.h"

namespace lowlap {
namespace {

struct ViewSlot {
  ViewId id = kInvalidId;
  Hash128::Value key;
  std::optional<DetectedFeatures> features;
  std::optional<Error> error;
};

}  // namespace

Result<KeyedFeatures> DetectFeatures(const Scene& scene,
                                     const FeatureOptions& options,
                                     const CacheFolder& cache_folder,
                                     const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::vector<ViewSlot> slots;
  for (const auto& [id, view] : scene.views) {
    slots.emplace_back();
    slots.back().id = id;
  }
  MeasurementCache cache(cache_folder, "features", context);
  const auto read_image = [&](ViewSlot* slot) {
    Result<std::string> bytes = ReadWholeFile(scene.ImagePath(slot->id));
    if (bytes) {
      slot->key = FeatureKey(*bytes, scene.FindIntrinsic(slot->id), options);
    } else {
      slot->error = bytes.error();
    }
    return bytes;
  };
  Status done = ParallelFor(
      context, "features in the cache", slots.size(), [&](std::size_t n) {
        if (!read_image(&slots[n])) return;
        slots[n].features = cache.Find(slots[n].key, FeaturesFromBytes);
      });
  if (!done) return tl::unexpected<Error>(done.error());

  std::vector<ViewSlot*> missing;
  for (ViewSlot& slot : slots) {
    if (!slot.features && !slot.error) missing.push_back(&slot);
  }
  cache.LogUse(
      std::count_if(slots.begin(), slots.end(),
                    [](const ViewSlot& s) { return s.features.has_value(); }),
      slots.size());
  const RunContext limited = WithinMemory(scene, options, context);
  const ReusedImageMemory reused_memory;
  done = ParallelFor(limited, "features", missing.size(), [&](std::size_t n) {
    ViewSlot* slot = missing[n];
    // Read again rather than kept: all images together may be large. The key
    // is then that of the bytes in use, even if the file has changed since.
    const Result<std::string> bytes = read_image(slot);
    if (!bytes) return;
    auto features = DetectFeaturesOfView(scene, slot->id, *bytes, options);
    if (!features) {
      slot->error = features.error();
      return;
    }
    cache.Write(slot->key, ToBytes(*features));
    slot->features = std::move(*features);
  });
  if (!done) return tl::unexpected<Error>(done.error());

  KeyedFeatures result;
  for (ViewSlot& slot : slots) {
    if (!slot.features) {
      result.failed.emplace(slot.id, *slot.error);
      continue;
    }
    result.keys.emplace(slot.id, slot.key);
    result.features.emplace(slot.id, std::move(*slot.features));
  }
  return result;
}

Result<std::map<ViewPair, PairMatches>> MatchFeatures(
    const KeyedFeatures& features, const std::vector<ViewPair>& pairs,
    const MatchOptions& options, const CacheFolder& cache_folder,
    const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  MeasurementCache cache(cache_folder, "matches", context);
  std::vector<Hash128::Value> keys(pairs.size());
  std::vector<std::optional<PairMatches>> found(pairs.size());
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const auto first = features.keys.find(pairs[n].first);
    const auto second = features.keys.find(pairs[n].second);
    if (first == features.keys.end() || second == features.keys.end()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "a pair names a view without features");
    }
    keys[n] = MatchKey(first->second, second->second, options);
    found[n] = cache.Find(keys[n], MatchesFromBytes);
  }
  std::vector<std::size_t> missing;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (!found[n]) missing.push_back(n);
  }
  cache.LogUse(pairs.size() - missing.size(), pairs.size());

  const Status done =
      ParallelFor(context, "matching", missing.size(), [&](std::size_t m) {
        const std::size_t n = missing[m];
        found[n] = MatchPair(features.features.at(pairs[n].first),
                             features.features.at(pairs[n].second), options);
        cache.Write(keys[n], ToBytes(*found[n]));
      });
  if (!done) return tl::unexpected<Error>(done.error());

  std::map<ViewPair, PairMatches> result;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    result.emplace(pairs[n], std::move(*found[n]));
  }
  return result;
}

}  // namespace lowlap
