#pragma once

#include <vector>

#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// A point matched between the middle view and one neighbour; normalised
/// coordinates, z = 1.
struct MatchedPoint {
  FeatureIndex point_in_middle = 0;
  Vec3 in_middle = Vec3::UnitZ();
  Vec3 in_neighbor = Vec3::UnitZ();
};

/// What a match says of the depth along one ray of the middle view: its
/// inverse, rho = 1 / z at unit baseline, which is linear in the image on a
/// plane (planes.h).
struct DepthSample {
  Vec3 ray = Vec3::UnitZ();  // in the middle view, z = 1
  double inverse_depth = 0;
  /// Of the inverse depth, to first order in the image noise (one pixel per
  /// coordinate of a point, `stddev_px` for the end points of a segment).
  double stddev = 0;
  /// Pixels that the transfer into the neighbour moves per unit of inverse
  /// depth: along the epipolar line of a point, across the segment of a line.
  double speed_px = 0;
  FeatureIndex feature = 0;  // in the middle view
  bool is_line = false;
};

/// The depth samples of a pair: one for a point, at the inverse depth that
/// turns R x + rho t closest to the observation y,
///   rho = ClosestDirection(y, R x, t);
/// two for a line, at the ends x of its segment in the middle view, where the
/// ray meets the interpretation plane l of the neighbour,
///   rho = - l . R x / l . t.
/// Left out: samples behind a camera (rho <= 0), and degenerate ones whose
/// stddev exceeds kMaxSampleStddev of the inverse depth: features near the
/// epipole, lines in an epipolar plane, depths far beyond the baseline.
std::vector<DepthSample> DepthSamples(const RigidTransform& camn_from_camj,
                                      double focal_j_px, double focal_n_px,
                                      const std::vector<MatchedPoint>& points,
                                      const std::vector<MatchedLine>& lines);

/// In units of the inverse depth. A sample that is less sure says as good as
/// nothing about a ratio; compare kMaxLogRatioStddev.
inline constexpr double kMaxSampleStddev = 0.3;

}  // namespace lowlap
