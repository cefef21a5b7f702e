#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/adjustment/internal/structure/landmark_status.h"
#include "lowlap/adjustment/internal/structure/point_shape.h"

namespace lowlap {

/// One feature that may show a point.
struct PointCandidate {
  int view = -1;  // index into CameraSet::views
  FeatureIndex feature = kInvalidId;
  Vec2 pixel_px = Vec2::Zero();
  PointShape shape;
  /// Divides an error by its deviation in each direction, that across the weak
  /// one being 1 (WhitenPoints).
  Mat2 whitening = Mat2::Identity();
  bool used = false;  // belongs to the landmark
};

/// A point track in views with poses, and the landmark made of it.
struct PointTrackState {
  PointTrackId id = kInvalidId;
  std::vector<PointCandidate> candidates;  // sorted by view
  Vec3 position = Vec3::Zero();
  LandmarkStatus status = LandmarkStatus::kTooFewViews;

  bool IsLandmark() const { return status == LandmarkStatus::kLandmark; }
  int UsedCount() const;
  /// Do the candidates in use come from two poses at least?
  bool HasTwoPoses(const CameraSet& cameras) const;
};

/// The projection less the observed pixel; nullopt for a point that the view
/// cannot see.
std::optional<Vec2> PointDifferencePx(const CameraSet& cameras,
                                      const PointCandidate& candidate,
                                      const Vec3& position);

/// Whitened distance of the projection from the observed pixel; infinity for a
/// point that the view cannot see.
double PointErrorPx(const CameraSet& cameras, const PointCandidate& candidate,
                    const Vec3& position);

struct PointTriangulationLimits {
  double threshold_px = std::numeric_limits<double>::infinity();
  double noise_px = 1;  // of one coordinate, for the uncertainty
  double max_relative_depth_stddev = 0.3;
};

/// Triangulates the track from its candidates and the poses, and marks those
/// in use. If all agree, from all; otherwise from the pair that most others
/// agree with (at most 45 pairs are tried), refined by Gauss-Newton on the
/// whitened errors of all that agree. A track with no solution ends with none
/// in use and the reason in `status`.
void TriangulatePointTrack(const CameraSet& cameras,
                           const PointTriangulationLimits& limits,
                           PointTrackState* track);

}  // namespace lowlap
