#include "lowlap/scene/features.h"

namespace lowlap {

NormalizedSegment NormalizeSegment(const LineSegment& segment,
                                   const Intrinsic& intrinsic) {
  NormalizedSegment normalized;
  const std::optional<Vec2> start = intrinsic.Normalize(segment.start_px);
  const std::optional<Vec2> end = intrinsic.Normalize(segment.end_px);
  if (!start || !end || *start == *end) return normalized;
  normalized.start = start->homogeneous();
  normalized.end = end->homogeneous();
  normalized.normal = normalized.start.cross(normalized.end).normalized();
  return normalized;
}

NormalizedFeatures NormalizeFeatures(const ViewFeatures& features,
                                     const Intrinsic& intrinsic) {
  NormalizedFeatures normalized;
  normalized.focal_px = intrinsic.MeanFocalPx();
  normalized.points.reserve(features.points_px.size());
  for (const Vec2& point_px : features.points_px) {
    const std::optional<Vec2> point = intrinsic.Normalize(point_px);
    normalized.points.push_back(point ? Vec3(point->homogeneous())
                                      : Vec3::Zero());
  }
  normalized.segments.reserve(features.segments.size());
  for (const LineSegment& segment : features.segments) {
    normalized.segments.push_back(NormalizeSegment(segment, intrinsic));
  }
  return normalized;
}

}  // namespace lowlap
