#include "lowlap/adjustment/internal/structure/coplanar_pairs.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lowlap {
namespace {

// Lines by the segments that observe them. A segment belongs to more than one
// only if tracks overlap.
using LinesBySegment = std::map<FeatureRef, std::vector<LineTrackId>>;

bool SeenIn(const LineLandmark& line, ViewId view) {
  return std::any_of(line.observations.begin(), line.observations.end(),
                     [&](const FeatureRef& ref) { return ref.view == view; });
}

// The line of a segment that the other view of its match sees too.
LineTrackId FindLine(const LinesBySegment& by_segment,
                     const std::map<LineTrackId, LineLandmark>& lines,
                     const FeatureRef& segment, ViewId other) {
  const auto found = by_segment.find(segment);
  if (found == by_segment.end()) return kInvalidId;
  for (const LineTrackId id : found->second) {
    if (SeenIn(lines.at(id), other)) return id;
  }
  return kInvalidId;
}

}  // namespace

std::vector<CoplanarPair> CollectCoplanarPairs(
    const std::vector<ScaleRatio>& ratios,
    const std::map<LineTrackId, LineLandmark>& lines, double min_angle_rad,
    StructureSummary* summary) {
  LinesBySegment by_segment;
  for (const auto& [id, line] : lines) {
    for (const FeatureRef& ref : line.observations) {
      by_segment[ref].push_back(id);
    }
  }
  std::set<CoplanarPair> pairs;
  for (const ScaleRatio& ratio : ratios) {
    if (ratio.verdict != RatioVerdict::kMeaningful) continue;
    const auto& [first, middle, last] = ratio.views;
    for (const CoplanarInlier& inlier : ratio.coplanar_inliers) {
      ++summary->coplanar_inliers;
      LineTrackId a =
          FindLine(by_segment, lines, {middle, inlier.line_in_first}, first);
      LineTrackId b =
          FindLine(by_segment, lines, {middle, inlier.line_in_last}, last);
      if (a == kInvalidId || b == kInvalidId) {
        ++summary->coplanar_without_lines;
        continue;
      }
      const double sine =
          lines.at(a).line.direction.cross(lines.at(b).line.direction).norm();
      if (a == b || sine < std::sin(min_angle_rad)) {
        ++summary->coplanar_parallel;
        continue;
      }
      if (a > b) std::swap(a, b);
      if (!pairs.insert({a, b}).second) ++summary->coplanar_duplicates;
    }
  }
  summary->coplanar_pairs = pairs.size();
  return {pairs.begin(), pairs.end()};
}

}  // namespace lowlap
