#pragma once

#include <optional>

#include "lowlap/adjustment/internal/structure/point_shape.h"
#include "lowlap/adjustment/internal/structure/track.h"
#include "lowlap/adjustment/internal/structure/track_fit.h"

namespace lowlap {

/// One feature that may show a point.
struct PointCandidate : TrackCandidate {
  Vec2 pixel_px = Vec2::Zero();
  PointShape shape;
  /// Divides an error by its deviation in each direction, that across the weak
  /// one being 1 (WhitenPoints).
  Mat2 whitening = Mat2::Identity();
};

struct PointTrackState : TrackState<PointTrackId, PointCandidate> {
  static constexpr int kUnknowns = 3;
  /// Squared length of the residual over squared ErrorPx.
  static constexpr int kResidualsPerError = 1;
  Vec3 position = Vec3::Zero();
};

/// The projection less the observed pixel; nullopt for a point that the view
/// cannot see.
std::optional<Vec2> PointDifferencePx(const CameraSet& cameras,
                                      const PointCandidate& candidate,
                                      const Vec3& position);

/// Distance of the projection from the observed pixel, in pixels of the
/// photograph; infinity for a point that the view cannot see.
double DistancePx(const CameraSet& cameras, const PointTrackState& track,
                  const PointCandidate& candidate);

/// The same, whitened.
double ErrorPx(const CameraSet& cameras, const PointTrackState& track,
               const PointCandidate& candidate);

/// Triangulates the track from its candidates and the poses, and marks those
/// in use: from the pair that most others agree with (at most 45 pairs are
/// tried), refined by Gauss-Newton on the whitened errors of all that agree. A
/// track with no solution ends with none in use and the reason in `status`.
void Triangulate(const CameraSet& cameras, const TriangulationLimits& limits,
                 PointTrackState* track);

/// A point from the candidates in use alone, and its covariance at whitened
/// errors of 1 px.
struct PointEstimate {
  Vec3 position;
  Mat3 unit_covariance;
};

/// Refines the track's point, whatever else it was adjusted to. nullopt: the
/// candidates do not determine it.
std::optional<PointEstimate> EstimateFromPixels(const CameraSet& cameras,
                                                const PointTrackState& track);

}  // namespace lowlap
