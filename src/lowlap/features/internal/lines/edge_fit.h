#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "lowlap/scene/features.h"

namespace lowlap {

/// Fits the support line of a segment to the edge beneath it.
///
/// Along the segment, the place of the steepest rise towards its bright side
/// is searched within `reach_px` across, to a fraction of a pixel; a line goes
/// through these places by iteratively reweighted least squares, and the
/// segment is cut back to the part where they are on the line. The standard
/// deviation of its end points follows from the scatter.
///
/// `blurred`: CV_32F grey values, smoothed by about one pixel. All positions
/// are pixels of this image. nullopt: no such edge under most of the segment.
std::optional<LineSegment> FitEdge(const cv::Mat& blurred, const Vec2& start_px,
                                   const Vec2& end_px, double reach_px);

}  // namespace lowlap
