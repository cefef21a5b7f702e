#pragma once

#include <optional>

#include "lowlap/adjustment/internal/costs/segment_rays.h"
#include "lowlap/adjustment/internal/structure/track.h"
#include "lowlap/adjustment/internal/structure/track_fit.h"
#include "lowlap/geometry/plucker_line.h"

namespace lowlap {

/// One segment that may show a line.
struct LineCandidate : TrackCandidate {
  SegmentRays rays;
  /// Reference noise level over that of the segment: errors of all segments
  /// are on the scale of the reference.
  double weight = 1;
};

/// The landmark: the points p + s d, |d| = 1, s in [low, high].
struct LineTrackState : TrackState<LineTrackId, LineCandidate> {
  static constexpr int kUnknowns = 4;
  /// Squared length of the residual over squared ErrorPx, a mean of two.
  static constexpr int kResidualsPerError = 2;
  Vec3 point = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();
  double low = 0;
  double high = 0;
};

/// Root mean square of the distances of the segment's two end points from the
/// image of the line, in pixels of the photograph; infinity where the segment,
/// lifted onto the line, lies behind the camera.
double DistancePx(const CameraSet& cameras, const LineTrackState& track,
                  const LineCandidate& candidate);

/// The same on the scale of the reference: times the weight of the candidate.
double ErrorPx(const CameraSet& cameras, const LineTrackState& track,
               const LineCandidate& candidate);

/// Triangulates the track as that of a point: the pair of segments whose line
/// most others agree with, refined by Levenberg-Marquardt on the end points'
/// distances of all that agree.
///
/// A line of two views has as many measurements as unknowns, so that its errors
/// say nothing: its segments must overlap on it (kImplausible otherwise). The
/// depth must be determined at both ends of the extent (kUncertain): not the
/// case near an epipolar plane.
void Triangulate(const CameraSet& cameras, const TriangulationLimits& limits,
                 LineTrackState* track);

/// A line from the segments in use alone, and for end points with 1 px of noise
/// the covariance of its four unknowns (a, b): with B = TangentBasis(d),
///   p' = p + B a,  d' = (d + B b) / |d + B b|.
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
