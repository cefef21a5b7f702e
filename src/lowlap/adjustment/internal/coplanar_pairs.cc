#include "lowlap/adjustment/internal/coplanar_pairs.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lowlap::internal {
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

struct Evidence {
  int ratios = 0;   // that found the pair
  double sine = 0;  // of the angle between the lines
};

// A pair stays if it is among the best of either of its lines.
std::vector<CoplanarPair> KeepBestOfEachLine(
    const std::map<CoplanarPair, Evidence>& evidence, int max_pairs_per_line) {
  std::vector<std::pair<CoplanarPair, Evidence>> ranked(evidence.begin(),
                                                        evidence.end());
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) {
                     return a.second.ratios != b.second.ratios
                                ? a.second.ratios > b.second.ratios
                                : a.second.sine > b.second.sine;
                   });
  std::map<LineTrackId, int> degree;
  std::vector<CoplanarPair> kept;
  for (const auto& [pair, unused] : ranked) {
    int& first = degree[pair.first];
    int& second = degree[pair.second];
    if (first >= max_pairs_per_line && second >= max_pairs_per_line) continue;
    ++first;
    ++second;
    kept.push_back(pair);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace

std::vector<CoplanarPair> CollectCoplanarPairs(
    const std::vector<ScaleRatio>& ratios,
    const std::map<LineTrackId, LineLandmark>& lines, double min_angle_rad,
    int max_pairs_per_line, StructureSummary* summary) {
  LinesBySegment by_segment;
  for (const auto& [id, line] : lines) {
    for (const FeatureRef& ref : line.observations) {
      by_segment[ref].push_back(id);
    }
  }
  std::map<CoplanarPair, Evidence> evidence;
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
      Evidence& pair = evidence[{a, b}];
      if (pair.ratios > 0) ++summary->coplanar_duplicates;
      ++pair.ratios;
      pair.sine = sine;
    }
  }
  std::vector<CoplanarPair> pairs =
      KeepBestOfEachLine(evidence, max_pairs_per_line);
  summary->coplanar_redundant = evidence.size() - pairs.size();
  summary->coplanar_pairs = pairs.size();
  return pairs;
}

}  // namespace lowlap::internal
