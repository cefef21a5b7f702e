#pragma once

#include <optional>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/matching/guided_match_options.h"
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

/// The line matches that are plausible under a known relative pose (at unit
/// baseline).
///
/// Two interpretation planes always meet in a line, so two views of an
/// infinite line constrain nothing; its segments do: the epipolar lines of the
/// end points of one segment cut the other line where the same 3D points must
/// appear. A match is kept if the intervals overlap enough in both views and
/// the triangulated line lies in front of both cameras over the overlap.
/// Matches that cannot be judged (a segment in an epipolar plane, an invalid
/// segment) are dropped.
std::vector<FeatureMatch> FilterLineMatches(
    const std::vector<FeatureMatch>& matches, const NormalizedFeatures& first,
    const NormalizedFeatures& second, const RigidTransform& cam2_from_cam1,
    const LineFilterOptions& options);

}  // namespace lowlap
