#include "lowlap/matching/internal/loops/match_loops.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace lowlap {
namespace {

// Of the longer side of a photograph. What lies between is told by neither:
// matches nearby move a little otherwise where surfaces end, and steps of fine
// patterns are small.
constexpr double kSamePlace = 0.03;
constexpr double kOtherPlace = 0.08;

// Of what lies between `least_px` and `greatest_px` off.
LoopVerdict VerdictOf(double least_px, double greatest_px,
                      double longer_side_px) {
  if (greatest_px < kSamePlace * longer_side_px) return LoopVerdict::kCloses;
  return least_px > kOtherPlace * longer_side_px ? LoopVerdict::kLeadsElsewhere
                                                 : LoopVerdict::kUntold;
}

// `compare` gives the verdict of a match through one detour.
template <class Detours, class Compare>
std::vector<LoopVerdict> VerdictsOfMost(
    const Detours& detours, const std::vector<FeatureMatch>& matches,
    const Compare& compare) {
  std::vector<LoopVerdict> verdicts;
  verdicts.reserve(matches.size());
  for (const FeatureMatch& match : matches) {
    int balance = 0;
    for (const auto& detour : detours) {
      const LoopVerdict verdict = compare(match, detour);
      balance += verdict == LoopVerdict::kCloses ? 1 : 0;
      balance -= verdict == LoopVerdict::kLeadsElsewhere ? 1 : 0;
    }
    verdicts.push_back(balance > 0   ? LoopVerdict::kCloses
                       : balance < 0 ? LoopVerdict::kLeadsElsewhere
                                     : LoopVerdict::kUntold);
  }
  return verdicts;
}

// Of the end points of a segment from a line.
struct LineDistances {
  double least_px = 0;
  double greatest_px = 0;
};

std::optional<LineDistances> DistancesFromLine(const Vec2& line_start_px,
                                               const Vec2& line_end_px,
                                               const Vec2& start_px,
                                               const Vec2& end_px) {
  const Vec2 along = line_end_px - line_start_px;
  if (!(along.norm() > 0)) return std::nullopt;
  const Vec2 normal = Vec2(-along.y(), along.x()).normalized();
  const double a = normal.dot(start_px - line_start_px);
  const double b = normal.dot(end_px - line_start_px);
  const bool crosses = a * b <= 0;
  return LineDistances{crosses ? 0 : std::min(std::abs(a), std::abs(b)),
                       std::max(std::abs(a), std::abs(b))};
}

}  // namespace

MatchLoops::MatchLoops(std::map<ViewId, View> views)
    : views_(std::move(views)) {}

void MatchLoops::Add(const ViewPair& pair,
                     const std::vector<FeatureMatch>& points) {
  const View &first = views_.at(pair.first), &second = views_.at(pair.second);
  if (!(first.longer_side_px > 0 && second.longer_side_px > 0)) return;
  std::vector<PlaceTransfer::Match> there, back;
  for (const FeatureMatch& match : points) {
    const Vec2& a = first.features->points_px[match.first];
    const Vec2& b = second.features->points_px[match.second];
    there.push_back({a, b});
    back.push_back({b, a});
  }
  transfers_[pair.first].insert_or_assign(
      pair.second, PlaceTransfer(there, kSamePlace * first.longer_side_px));
  transfers_[pair.second].insert_or_assign(
      pair.first, PlaceTransfer(back, kSamePlace * second.longer_side_px));
}

std::vector<MatchLoops::Detour> MatchLoops::DetoursOf(
    const ViewPair& pair) const {
  std::vector<Detour> detours;
  const auto of_first = transfers_.find(pair.first);
  const auto of_second = transfers_.find(pair.second);
  if (of_first == transfers_.end() || of_second == transfers_.end()) {
    return detours;
  }
  for (const auto& [third, transfer] : of_first->second) {
    const auto other = of_second->second.find(third);
    if (other == of_second->second.end()) continue;
    detours.push_back(
        {&transfer, &other->second, views_.at(third).longer_side_px});
  }
  return detours;
}

std::vector<LoopVerdict> MatchLoops::OfPoints(
    const ViewPair& pair, const std::vector<FeatureMatch>& matches) const {
  const auto& points1_px = views_.at(pair.first).features->points_px;
  const auto& points2_px = views_.at(pair.second).features->points_px;
  return VerdictsOfMost(
      DetoursOf(pair), matches,
      [&](const FeatureMatch& match, const Detour& detour) {
        const auto a = detour.from_first->Apply(points1_px[match.first]);
        if (!a) return LoopVerdict::kUntold;
        const auto b = detour.from_second->Apply(points2_px[match.second]);
        if (!b) return LoopVerdict::kUntold;
        const double distance_px = (*a - *b).norm();
        return VerdictOf(distance_px, distance_px, detour.longer_side_px);
      });
}

std::vector<LoopVerdict> MatchLoops::OfLines(
    const ViewPair& pair, const std::vector<FeatureMatch>& matches) const {
  const auto& segments1 = views_.at(pair.first).features->segments;
  const auto& segments2 = views_.at(pair.second).features->segments;
  return VerdictsOfMost(
      DetoursOf(pair), matches,
      [&](const FeatureMatch& match, const Detour& detour) {
        const LineSegment& segment1 = segments1[match.first];
        const LineSegment& segment2 = segments2[match.second];
        const auto start1 = detour.from_first->Apply(segment1.start_px);
        const auto end1 = detour.from_first->Apply(segment1.end_px);
        if (!start1 || !end1) return LoopVerdict::kUntold;
        const auto start2 = detour.from_second->Apply(segment2.start_px);
        const auto end2 = detour.from_second->Apply(segment2.end_px);
        if (!start2 || !end2) return LoopVerdict::kUntold;
        const auto distances =
            DistancesFromLine(*start1, *end1, *start2, *end2);
        if (!distances) return LoopVerdict::kUntold;
        return VerdictOf(distances->least_px, distances->greatest_px,
                         detour.longer_side_px);
      });
}

}  // namespace lowlap
