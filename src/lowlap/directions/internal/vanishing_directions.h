#pragma once

#include <vector>

#include "lowlap/directions/vanishing_options.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// The common direction of a set of parallel lines, as one view shows it.
struct VanishingDirection {
  Vec3 direction = Vec3::UnitZ();  // unit, of either sign
  /// Of the direction; its null space is the direction itself.
  Mat3 covariance = Mat3::Zero();
  std::vector<int> segments;  // ascending
  double log10_nfa = 0;
};

/// The covariance with a deviation across the direction added, in radians: by
/// how much lines that share it are not parallel.
Mat3 WidenedCovariance(const VanishingDirection& direction, double stddev_rad);

/// Vanishing directions without any assumption on the angles between them.
///
/// A direction d fits a segment with end points a, b and midpoint m if an end
/// point lies close to the line m x d that joins the midpoint to the vanishing
/// point: e = |d . (a x b)| / (2 |(m x d)_12|) f pixels. Candidates are the
/// crossings of pairs of long segments; the one whose parallel segments are
/// least expected by chance (a segment of length L that runs anywhere has
/// e <= t with probability (2 / pi) asin(2 t / L); the number of them is
/// bounded by Chernoff's inequality) is fitted robustly to its segments, these
/// are set aside, and the search goes on while candidates are meaningful (NFA <
/// 1). The covariance is that of the fit, with the scatter found in it.
/// `pixel_unit`: PixelUnit of the image; t is in such pixels.
std::vector<VanishingDirection> FindVanishingDirections(
    const NormalizedFeatures& features, const VanishingOptions& options,
    double pixel_unit = 1);

/// The direction that best fits the given segments (at least two), starting
/// from one that most of them agree with; log10_nfa stays zero.
VanishingDirection FitDirection(const NormalizedFeatures& features,
                                const std::vector<int>& segments,
                                const Vec3& start,
                                const VanishingOptions& options);

}  // namespace lowlap
