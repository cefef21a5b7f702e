#pragma once

#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/features/feature_options.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Raised whenever the segments change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kLineDetectorVersion = 2;

/// Straight segments over several scales: LSD (Grompone von Gioi et al. 2012,
/// by OpenCV) on every level of a pyramid; segments of different levels that
/// lie on one another, and collinear pieces of one broken segment, are merged;
/// the support line of each is then fitted to the gradient at full resolution.
///
/// A segment runs such that the brighter side lies on its left as seen in the
/// image (y down): the direction carries the polarity of the edge. Sorted from
/// long to short. An image without edges has no segments.
Result<std::vector<LineSegment>> DetectLines(const GrayImage& image,
                                             const LineOptions& options);

}  // namespace lowlap
