#pragma once

#include <optional>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Two segments, one per view, taken as images of one 3D line at unit baseline.
struct LineTransfer {
  /// The part of the line that both segments show, relative to the shorter and
  /// to the longer of the two in their images.
  double overlap_of_shorter = 0;
  double overlap_of_longer = 0;
  /// Both run in the same direction in space.
  bool same_polarity = false;
  /// The line's plane through the centre of camera 2, n . X = offset in camera
  /// 1: a ray x of camera 1 meets it at the depth offset / (n . x).
  Vec3 plane = Vec3::Zero();
  double offset = 0;
};

/// What the epipolar lines of the end points say about a pair of segments.
///
/// `epipolar_slack`: by how much epipolar lines may be off, in normalised
/// units; a segment at the angle a to them may slide along its line by slack /
/// sin a, and the common part counts as longer by this, if at most whole.
/// nullopt: invalid segments; one of them closer than asin(min_epipolar_sine)
/// to an epipolar line; no common part in front of both cameras.
std::optional<LineTransfer> TransferLine(const NormalizedSegment& first,
                                         const NormalizedSegment& second,
                                         const RigidTransform& cam2_from_cam1,
                                         double min_epipolar_sine,
                                         double epipolar_slack);

/// Sine of the angle in the image between a segment and the epipolar line of
/// its midpoint. `epipole` is the other camera's centre in this camera.
double EpipolarSine(const NormalizedSegment& segment, const Vec3& epipole);

}  // namespace lowlap
