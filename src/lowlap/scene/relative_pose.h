#pragma once

#include <optional>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// Another motion that the matches of a pair allow: the second motion of a
/// plane, until triplets and lines decide.
struct AlternativeMotion {
  Mat3 rotation = Mat3::Identity();
  Vec3 direction = Vec3::UnitX();
  double log10_nfa = 0;
  std::optional<Eigen::Matrix<double, 5, 5>> covariance;

  friend bool operator==(const AlternativeMotion& a,
                         const AlternativeMotion& b) {
    return a.rotation == b.rotation && a.direction == b.direction &&
           a.log10_nfa == b.log10_nfa && a.covariance == b.covariance;
  }
};

/// What speaks against a relative pose that its matches bear out.
enum class PoseWeakness {
  /// Matches that lie apart say nothing for it.
  kMatchesSideBySide,
  /// What surrounds its matches does not match.
  kSurroundings,
  /// Nearly all that bears it out repeats within its photographs, or what looks
  /// the same elsewhere bears out another motion.
  kRepeats,
};

/// "matches_side_by_side", "surroundings", "repeats".
const char* PoseWeaknessName(PoseWeakness weakness);

/// Rotation and unit direction of a pair of views (first < second):
///   x_second = rotation x_first + lambda direction,  lambda > 0 unknown.
struct RelativePose {
  ViewPair views;
  Mat3 rotation = Mat3::Identity();  // cam2_from_cam1
  Vec3 direction = Vec3::UnitX();    // unit, in camera 2
  std::vector<FeatureMatch> point_inliers;
  std::vector<FeatureMatch> line_inliers;  // segment indices
  double log10_nfa = 0;
  /// The a-contrario threshold that separated the point inliers; 0 if unknown.
  double point_threshold_px = 0;
  /// Covariance of (rotation error in radians, in camera 2; direction error in
  /// the two axes of TangentBasis(direction)). Absent if unknown.
  std::optional<Eigen::Matrix<double, 5, 5>> covariance;
  /// In the frames, and with the inliers, of the motion above.
  std::vector<AlternativeMotion> alternatives;
  /// If there is one, the pose may join two places that look alike, and is to
  /// be believed only as far as others confirm it.
  std::optional<PoseWeakness> weakness;

  /// At unit baseline.
  RigidTransform Cam2FromCam1() const { return {rotation, direction}; }

  /// Its own motion, as an alternative to another one.
  AlternativeMotion AsAlternative() const {
    return {rotation, direction, log10_nfa, covariance};
  }
  /// The pose with another motion and no alternatives.
  RelativePose WithMotion(const AlternativeMotion& motion) const;

  friend bool operator==(const RelativePose& a, const RelativePose& b);
};

/// `to_from_from` at unit baseline for an edge in either direction; `from` and
/// `to` must be its two views.
RigidTransform UnitTransform(const RelativePose& edge, ViewId from, ViewId to);

}  // namespace lowlap
