#pragma once

#include <map>
#include <utility>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/scale/evidence/internal/coplanar_candidates.h"
#include "lowlap/scale/evidence/internal/plane_points.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_geometry.h"
#include "lowlap/scene/normalized_features.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Everything that one triplet knows about its ratio, in the frame of the
/// middle camera; the whole input of a ScaleEstimator.
struct TripletView {
  ViewTriplet views;
  TripletGeometry geometry;
  /// The geometry with one standard deviation added along each independent
  /// error of the two relative poses; empty where that is unknown.
  std::vector<TripletGeometry> pose_perturbations;
  double image_area_px2 = 1;     // of the middle view
  double image_diagonal_px = 1;  // of the middle view

  std::vector<TrifocalPoint> points;
  std::vector<TrifocalLine> lines;
  std::vector<MatchedLine> lines_ij;
  std::vector<MatchedLine> lines_jk;
  CoplanarPairCandidates coplanar;
  std::vector<PlanePoint> plane_points;
};

using NormalizedFeaturesByView = std::map<ViewId, NormalizedFeatures>;
/// By middle view and neighbour.
using PlanesByPair = std::map<std::pair<ViewId, ViewId>, PairPlanes>;

/// NormalizeFeatures for every view that has features and an intrinsic.
NormalizedFeaturesByView NormalizeAllFeatures(const Scene& scene);

/// Reads a triplet out of the scene: the inlier matches of its two relative
/// poses, chained through the feature index in the middle view (points: every
/// combination, where one is matched more than once; lines: the pieces of a
/// broken segment joined, see GroupMatches), and the coplanar candidates. Only
/// the kinds that `options` enables are filled; plane points from `planes`
/// (planes_by_pair.h), or from planes found here if there are none.
///
/// Errors: kInvalidArgument if one of the two relative poses, or the middle
/// view's intrinsic, is missing; kInvalidScene if a match refers to a feature
/// that does not exist.
Result<TripletView> MakeTripletView(const Scene& scene,
                                    const NormalizedFeaturesByView& features,
                                    const ViewTriplet& views,
                                    const ScaleOptions& options,
                                    const PlanesByPair* planes = nullptr);

}  // namespace lowlap
