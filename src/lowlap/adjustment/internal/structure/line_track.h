#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "lowlap/adjustment/internal/costs/segment_rays.h"
#include "lowlap/adjustment/internal/structure/landmark_status.h"
#include "lowlap/geometry/plucker_line.h"

namespace lowlap {

/// One segment that may show a line.
struct LineCandidate {
  int view = -1;  // index into CameraSet::views
  FeatureIndex feature = kInvalidId;
  SegmentRays rays;
  /// Reference noise level over that of the segment: errors of all segments
  /// are on the scale of the reference.
  double weight = 1;
  bool used = false;
};

/// A line track in views with poses, and the landmark made of it: the points
/// p + s d, |d| = 1, s in [low, high].
struct LineTrackState {
  LineTrackId id = kInvalidId;
  std::vector<LineCandidate> candidates;  // sorted by view
  Vec3 point = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();
  double low = 0;
  double high = 0;
  LandmarkStatus status = LandmarkStatus::kTooFewViews;

  bool IsLandmark() const { return status == LandmarkStatus::kLandmark; }
  int UsedCount() const;
  /// Number of poses that the candidates in use come from.
  int PoseCount(const CameraSet& cameras) const;
  PluckerLine Line() const {
    return PluckerLine::FromPointAndDirection(point, direction);
  }
};

/// Root mean square of the distances of the segment's two end points from the
/// image of the line, in pixels; infinity where the segment, lifted onto the
/// line, lies behind the camera.
double LineErrorPx(const CameraSet& cameras, const LineCandidate& candidate,
                   const Vec3& point, const Vec3& direction);

struct LineTriangulationLimits {
  double threshold_px = std::numeric_limits<double>::infinity();
  double noise_px = 1;  // of an end point's distance, for the uncertainty
  double max_relative_depth_stddev = 0.3;
  double min_two_view_overlap = 0.2;
};

/// Triangulates the track, like TriangulatePointTrack: the pair of segments
/// whose line most others agree with, refined by Levenberg-Marquardt on the end
/// points' distances of all that agree.
///
/// A line of two views has as many measurements as unknowns, so that its errors
/// say nothing: its segments must overlap on it (kImplausible otherwise). The
/// depth must be determined at both ends of the extent (kUncertain): not the
/// case near an epipolar plane.
void TriangulateLineTrack(const CameraSet& cameras,
                          const LineTriangulationLimits& limits,
                          LineTrackState* track);

/// A line from the segments in use alone, with the covariance of its four
/// unknowns (LineNormalEquations) for end points with 1 px of noise.
struct LineEstimate {
  Vec3 point;
  Vec3 direction;
  Eigen::Matrix4d unit_covariance;
};

/// Refines the track's line, whatever else it was adjusted to. nullopt: the
/// segments do not determine it.
std::optional<LineEstimate> EstimateFromSegments(const CameraSet& cameras,
                                                 const LineTrackState& track);

/// Lifts the segments in use onto the line: sets low and high, and moves
/// `point` to their middle. Rays almost along the line have no say.
void UpdateLineExtent(const CameraSet& cameras, LineTrackState* track);

}  // namespace lowlap
