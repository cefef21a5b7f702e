#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/feature_options.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/features/internal/points/point_detector.h"

namespace lowlap {

/// The points of an image that is also looked at from aside (Morel & Yu, ASIFT:
/// A New Framework for Fully Affine Invariant Image Comparison, SIAM J. Imaging
/// Sciences 2009).
struct TiltedPoints {
  /// What is found in one tilted image.
  struct Look {
    std::vector<PointDescriptor> descriptors;
    /// The point that each belongs to: of those that DetectPoints finds in the
    /// image, followed by `added`.
    std::vector<FeatureIndex> points;
  };

  /// Points that the image itself does not show, with the descriptors by which
  /// they were found first.
  PointFeatures added;
  /// The image itself, then growing tilts.
  std::vector<Look> looks;
};

/// Raised whenever the points change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kTiltedPointsVersion = 3;

/// Detects points (DetectPoints; `untilted` are those of the image itself) in
/// the image compressed by 2^(1/2), 2, ... up to max_tilt, each in directions
/// 72 degrees / tilt apart; a larger image is reduced first. A point belongs to
/// one found before if it lies within a pixel of it or a quarter of its scale,
/// and the scales differ by less than half. Blobs that reach beyond the border
/// of the image are left out. kCancelled if the context's progress asks for it.
Result<TiltedPoints> DetectTiltedPoints(const GrayImage& image,
                                        const PointFeatures& untilted,
                                        const PointOptions& points,
                                        const TiltOptions& tilts,
                                        const RunContext& context);

}  // namespace lowlap
