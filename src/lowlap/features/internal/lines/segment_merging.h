#pragma once

#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// A segment as one level of the pyramid saw it, in full-resolution pixels.
struct RawSegment {
  Vec2 start_px = Vec2::Zero();
  Vec2 end_px = Vec2::Zero();
  int level = 0;  // pixels of the level are 2^level full-resolution pixels wide

  double LengthPx() const { return (end_px - start_px).norm(); }
};

/// An order of segments (RawSegment, LineSegment) from long to short.
template <class Segment>
bool LongerFirst(const Segment& a, const Segment& b) {
  const double la = a.LengthPx(), lb = b.LengthPx();
  if (la != lb) return la > lb;
  if (a.start_px.y() != b.start_px.y()) return a.start_px.y() < b.start_px.y();
  return a.start_px.x() < b.start_px.x();
}

/// Joins the segments of all levels, finest first, into one set. A coarse
/// segment sees an edge whole that noise and crossings break on finer levels:
/// the pieces that lie on it and are collinear at their own precision become
/// one segment. A coarse segment that finer ones do not explain (a blurred
/// edge) is kept itself. At last, collinear segments with a small gap between
/// them are joined. Segments of opposite polarity are never joined.
std::vector<RawSegment> MergeLevels(
    const std::vector<std::vector<RawSegment>>& levels);

/// Drops every segment of which more than half lies on a longer one.
/// `segments` must be sorted from long to short; returns the indices to keep.
std::vector<std::size_t> WithoutDuplicates(
    const std::vector<RawSegment>& segments, double max_distance_px);

}  // namespace lowlap
