#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/directions/vanishing_options.h"
#include "lowlap/features/feature_options.h"
#include "lowlap/matching/match_options.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/two_view_options.h"

namespace lowlap {

struct RelativePoseOptions {
  PairOptions pair;
  VanishingOptions vanishing;
  LineTrackOptions line_tracks;

  Status Validate() const;
};

struct MeasurementOptions {
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

/// What became of one pair.
struct PairReport {
  ViewPair views;
  bool accepted = false;
  /// Not accepted: a rotation alone explains what the two views see.
  bool no_parallax = false;
  std::string reason;  // why not, if not
  std::string geometry;
  int num_point_matches = 0;
  int num_line_matches = 0;
  int num_point_inliers = 0;
  int num_line_inliers = 0;
  double log10_nfa = 0;
};

/// A view without any relative pose.
struct UnrelatedView {
  ViewId view = kInvalidId;
  bool no_parallax = false;  // so are all its pairs that the points explain
  std::string reason;
};

/// From photographs to measurements: detects features in the images of all
/// views (Scene::ImagePath), matches the selected pairs, and fills
/// scene->features, relative_poses, unrelated_pairs and tracks, with the
/// intrinsics that the scene has. Features that no inlier uses are dropped, so
/// that the scene stays small. Returns what became of every pair.
///
/// An image that fails is left out with its pairs, with a warning; the first
/// error is returned if fewer than two are left. The result depends neither on
/// the number of threads nor on what a cache holds. A cancelled run leaves the
/// cache in order. `stages` may be null.
Result<std::vector<PairReport>> MeasureImages(Scene* scene,
                                              const MeasurementOptions& options,
                                              const RunContext& context,
                                              StageLog* stages);

}  // namespace lowlap
