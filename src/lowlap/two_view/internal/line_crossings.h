#pragma once

#include <array>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// The point where the support lines of two segments cross, in two views.
struct LineCrossing {
  Vec3 x1 = Vec3::UnitZ();  // normalised, z = 1
  Vec3 x2 = Vec3::UnitZ();
  /// Of its position, in units of the variance of a segment's end point across
  /// the segment: with the crossing at share s of a segment's way from start to
  /// end, its line is there to within (1 - s)^2 + s^2.
  Mat2 covariance1 = Mat2::Identity();
  Mat2 covariance2 = Mat2::Identity();
  /// The two that cross, by their place among the matches.
  std::array<int, 2> matches = {};
};

/// Crossings of neighbouring matched lines, as points to be tried: where the
/// two lines lie in one plane (the frame of a door, the corner of a table),
/// they meet in space, and the crossing is a point like any other, often more
/// precise than a blob; where they do not, it is an outlier. Candidates are
/// couples of matches whose segments make an angle of at least 20 degrees and
/// come closer to their crossing, in both views, than a twentieth of their
/// length and `focal / 100`; every match joins at most four, the closest,
/// and of those within their segments the most precise, whatever the order of
/// the matches. Sorted by match.
std::vector<LineCrossing> FindLineCrossings(
    const NormalizedFeatures& features1, const NormalizedFeatures& features2,
    const std::vector<FeatureMatch>& line_matches);

}  // namespace lowlap
