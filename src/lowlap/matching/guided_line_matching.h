#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/matching/line_matching.h"
#include "lowlap/scene/normalized_features.h"

namespace lowlap {

struct GuidedLineOptions {
  /// Greatest Hamming distance of two descriptors of 256 bits; the geometry
  /// leaves few partners, so this may be wider than without it.
  int max_distance_bits = 110;
  /// Least overlap of two segments along the line, after transfer by the
  /// epipolar lines of the end points, relative to the shorter of the two.
  double min_overlap = 0.5;
  /// A line closer than this to an epipolar plane has no depth, and the
  /// transfer of its end points says nothing: no match.
  double min_epipolar_angle_deg = 1.0;
  /// By how much the epipolar lines of a pose may be off, in pixels.
  double epipolar_tolerance_px = 2.0;
  /// Least score of a match, in [0, 1].
  double min_score = 0.07;

  Status Validate() const;
};

/// Segment matches under a known relative pose (at unit baseline), sorted.
///
/// `first_normalized`, `second_normalized` hold the same segments undistorted.
/// `seeds`: matches found without the pose; those that the pose contradicts
/// are dropped, the others take part with an advantage over new ones.
///
/// A candidate is a pair of segments of the same polarity whose epipolar
/// transfers overlap, whose line lies in front of both cameras, and whose
/// descriptors are not too far apart. Its score grows with the similarity, the
/// overlap and the agreement with the candidates around it, by relaxation:
/// neighbours in the image that lie at the depth of one common surface.
/// Conflicts are resolved by score; a match that is hardly better than
/// one that contradicts it is not made.
///
/// A segment may have several partners if these are collinear pieces of one
/// broken edge that lie one behind the other: every match of a piece is listed.
std::vector<FeatureMatch> MatchLinesGuided(
    const DescribedLines& first, const DescribedLines& second,
    const NormalizedFeatures& first_normalized,
    const NormalizedFeatures& second_normalized,
    const RigidTransform& cam2_from_cam1,
    const std::vector<FeatureMatch>& seeds, const GuidedLineOptions& options);

}  // namespace lowlap
