#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The cameras of a triplet (i, j, k) in the frame of the middle camera j.
///
/// Both relative poses are at unit baseline: the centre of camera i in camera
/// j is lambda_i b_i with |b_i| = 1, and likewise for k. The unknown of the
/// whole folder is tau = lambda_k / lambda_i > 0; lambda_i = 1 is the gauge.
struct TripletGeometry {
  RigidTransform cami_from_camj;  // unit baseline
  RigidTransform camk_from_camj;  // unit baseline
  /// Pixels per unit of normalised coordinates in each view.
  double focal_i_px = 1;
  double focal_j_px = 1;
  double focal_k_px = 1;

  /// The same triplet read from the other end: tau becomes 1 / tau.
  TripletGeometry Swapped() const {
    return {camk_from_camj, cami_from_camj, focal_k_px, focal_j_px, focal_i_px};
  }
};

/// A point matched in (i, j) and in (j, k); normalised coordinates, z = 1.
struct TripletPoint {
  FeatureIndex point_in_middle = 0;
  Vec3 in_i = Vec3::UnitZ();
  Vec3 in_j = Vec3::UnitZ();
  Vec3 in_k = Vec3::UnitZ();
};

/// A segment as one view sees it, with the standard deviation of its end
/// points across the segment.
struct ObservedSegment {
  NormalizedSegment segment;
  double stddev_px = 0.5;
};

/// A line matched in (i, j) and in (j, k).
struct TripletLine {
  FeatureIndex segment_in_middle = 0;
  ObservedSegment in_i;
  ObservedSegment in_j;
  ObservedSegment in_k;
};

/// A line matched between the middle view and one neighbour.
struct MatchedLine {
  FeatureIndex segment_in_middle = 0;
  ObservedSegment in_middle;
  ObservedSegment in_neighbor;
};

enum class CandidateStatus {
  kValid,
  kDegenerate,     // the feature says (next to) nothing about tau
  kNegativeDepth,  // tau < 0, or a feature behind a camera: contradicts the
                   // poses
};

/// The log ratio that one feature asks for.
struct RatioCandidate {
  CandidateStatus status = CandidateStatus::kDegenerate;
  double log_ratio = 0;
  /// To first order in the image noise: one pixel per coordinate of a point,
  /// `stddev_px` for the end points of a segment.
  double log_ratio_stddev = 0;
};

/// A scene with its features as the geometry sees them; refers to the scene.
struct SceneFeatures {
  explicit SceneFeatures(const Scene& of_scene);

  const Scene& scene;
  /// NormalizeFeatures of every view that has features and an intrinsic.
  std::map<ViewId, NormalizedFeatures> normalized;
  /// Of the same views: the line track of every segment, kInvalidId without
  /// one, the first if there are several.
  std::map<ViewId, std::vector<LineTrackId>> line_tracks;

  /// False if a view of the triplet has no intrinsic or no features.
  bool HasAll(const ViewTriplet& views) const;
};

/// What the features and relative poses of a triplet say, in the frame of the
/// middle camera; what kinds of evidence look at.
struct TripletView {
  ViewTriplet views;
  TripletGeometry geometry;
  /// The geometry with one standard deviation added along each independent
  /// error of the two relative poses and, next to it, taken off; empty where
  /// that is unknown.
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
/// poses, chained through the middle view. Points: through the feature index,
/// every combination where one is matched more than once; of points at the same
/// places of all three views, as detectors give of one blob with two
/// orientations, the first, for they err together. Lines: through the
/// line track of the segments; the longest of its matched pieces in a view
/// stands for the line, which says what one line says however often it is
/// broken. Matches of segments of different tracks, which BuildLineTracks
/// refused, are left out. A segment of the middle view without a track is a
/// line of its own, with the longest of its matches.
///
/// Errors: kInvalidArgument if one of the two relative poses, or the middle
/// view's intrinsic, is missing; kInvalidScene if a match refers to a feature
/// that does not exist.
Result<TripletView> MakeTripletView(const SceneFeatures& features,
                                    const ViewTriplet& views);

}  // namespace lowlap
