#pragma once

#include <map>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/pipeline/internal/measure/cache/cache_folder.h"
#include "lowlap/pipeline/internal/measure/cache/cached_measurements.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Matches the starved pairs (TiltedPointOptions) once more by what their
/// images show when they are looked at from aside (DetectTiltedPoints,
/// MatchTiltedPoints), and adds the points found so to the features of their
/// views, after those that are there. `cache` may be null; it has no influence
/// on the result. Errors: those of the images.
Status MatchStarvedPairs(const Scene& scene, const MeasurementOptions& options,
                         const CacheFolder* cache, const RunContext& context,
                         KeyedFeatures* detected,
                         std::map<ViewPair, PairMatches>* matches);

}  // namespace lowlap
