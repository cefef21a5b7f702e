#pragma once

#include <map>
#include <vector>

#include "lowlap/core/internal/hash.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/pipeline/internal/measure/cache/cache_folder.h"

namespace lowlap {

// DetectFeatures and MatchFeatures with a cache, with the same results to the
// bit. Entries are found by content: the image file's bytes (for matches: the
// keys of the two sets of features), options, and versions of the algorithms.
// Each is written as soon as it is computed, so that a run that is stopped or
// killed at any moment loses the work in progress only. A damaged entry is
// computed anew, with a warning; a cache that cannot be written is one warning
// too. How much came from the cache is logged.

struct KeyedFeatures {
  std::map<ViewId, DetectedFeatures> features;
  std::map<ViewId, Hash128::Value> keys;
  std::map<ViewId, Error> failed;  // views whose images cannot be used
};

/// Errors as in DetectFeatures, but for those of single images.
Result<KeyedFeatures> DetectFeatures(const Scene& scene,
                                     const FeatureOptions& options,
                                     const CacheFolder& cache,
                                     const RunContext& context);

/// Errors as in MatchFeatures.
Result<std::map<ViewPair, PairMatches>> MatchFeatures(
    const KeyedFeatures& features, const std::vector<ViewPair>& pairs,
    const MatchOptions& options, const CacheFolder& cache,
    const RunContext& context);

}  // namespace lowlap
