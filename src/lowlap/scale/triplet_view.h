#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/scale/triplet_geometry.h"
#include "lowlap/scene/normalized_features.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A scene with its features as the geometry sees them; refers to the scene.
struct SceneFeatures {
  explicit SceneFeatures(const Scene& of_scene);

  const Scene& scene;
  /// NormalizeFeatures of every view that has features and an intrinsic.
  std::map<ViewId, NormalizedFeatures> normalized;

  /// False if a view of the triplet has no intrinsic or no features.
  bool HasAll(const ViewTriplet& views) const;
};

/// What the features and relative poses of a triplet say, in the frame of the
/// middle camera; what kinds of evidence look at.
struct TripletView {
  ViewTriplet views;
  TripletGeometry geometry;
  /// The geometry with one standard deviation added along each independent
  /// error of the two relative poses; empty where that is unknown.
  std::vector<TripletGeometry> pose_perturbations;
  double image_area_px2 = 1;     // of the middle view
  double image_diagonal_px = 1;  // of the middle view

  /// Matched in both pairs.
  std::vector<TripletPoint> points;
  std::vector<TripletLine> lines;
  /// Matched in one pair at least.
  std::vector<MatchedLine> lines_ij;
  std::vector<MatchedLine> lines_jk;
};

/// Reads a triplet out of the scene: the inlier matches of its two relative
/// poses, chained through the feature index in the middle view. Points: every
/// combination, where one is matched more than once; lines: the pieces of a
/// fragmented segment joined (GroupMatches).
///
/// Errors: kInvalidArgument if one of the two relative poses, or the middle
/// view's intrinsic, is missing; kInvalidScene if a match refers to a feature
/// that does not exist.
Result<TripletView> MakeTripletView(const SceneFeatures& features,
                                    const ViewTriplet& views);

}  // namespace lowlap
