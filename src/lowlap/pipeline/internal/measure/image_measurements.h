#pragma once

#include <map>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/pipeline/measure_images.h"

namespace lowlap {

/// What is measured in the photographs themselves.
struct ImageMeasurements {
  std::map<ViewId, DetectedFeatures> features;
  std::map<ViewPair, PairMatches> matches;  // of the selected pairs
  /// Views left out, since their images cannot be used.
  std::map<ViewId, Error> failed;
};

/// Detects features in the images of all views and matches the selected pairs.
/// An image that fails is left out with its pairs, with a warning; the first
/// error is returned if fewer than two are left.
/// The result does not depend on what a cache holds. A cancelled run leaves
/// the cache in order.
Result<ImageMeasurements> MatchImages(const Scene& scene,
                                      const MeasurementOptions& options,
                                      const RunContext& context,
                                      StageLog* stages);

/// Fills scene->features, relative_poses, unrelated_pairs and tracks, with the
/// intrinsics that the scene has. Features that no inlier uses are dropped
/// (KeepMatchedFeatures), so that the scene stays small.
Result<std::vector<PairReport>> RelatePairs(
    const ImageMeasurements& measurements, const MeasurementOptions& options,
    const RunContext& context, StageLog* stages, Scene* scene);

}  // namespace lowlap
