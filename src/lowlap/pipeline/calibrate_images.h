#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/features.h"
#include "lowlap/matching/matching.h"
#include "lowlap/matching/pair_retrieval.h"
#include "lowlap/matching/subpixel_refinement.h"
#include "lowlap/pipeline/relative_poses.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct FrontEndOptions {
  /// See SelectViewPairs; or "auto", what RetrievePairs finds in the features.
  std::string pairs = "all";
  RetrievalOptions retrieval;
  FeatureOptions features;
  MatchOptions matching;
  RelativePoseOptions relative_poses;
  /// Moves the points of tracks by comparing grey values (RefinePointTracks),
  /// and refines the relative poses on them.
  bool refine_points = false;
  PatchAlignmentOptions refinement;
  /// Folder of features and matches that are used again; empty: none.
  std::string cache_folder;
  /// Entries that were not used for long are removed beyond this.
  double max_cache_gb = 4;

  Status Validate() const;
};

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
                                      const FrontEndOptions& options,
                                      const RunContext& context,
                                      StageLog* stages);

/// Fills scene->features, relative_poses and tracks, with the intrinsics that
/// the scene has. Features that no inlier uses are dropped
/// (KeepMatchedFeatures), so that the scene stays small.
Result<std::vector<PairReport>> RelatePairs(
    const ImageMeasurements& measurements, const FrontEndOptions& options,
    const RunContext& context, StageLog* stages, Scene* scene);

/// From photographs to measurements: both.
Result<std::vector<PairReport>> MeasureImages(Scene* scene,
                                              const FrontEndOptions& options,
                                              const RunContext& context,
                                              StageLog* stages);

}  // namespace lowlap
