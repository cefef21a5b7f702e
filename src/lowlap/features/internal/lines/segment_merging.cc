#include "lowlap/features/internal/lines/segment_merging.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/features/internal/lines/midpoint_grid.h"

namespace lowlap {
namespace {

// A level localises an edge to about this many of its pixels.
constexpr double kLateralTolerance = 0.75;
// Pieces of one edge are this straight, in pixels of the finer level.
constexpr double kStraightness = 1.2;
// Collinear segments are one if the gap between them is below this share of the
// shorter: a bar or a shadow across the edge.
constexpr double kMaxGapShare = 0.15;
// Share of a merged segment, or of a coarse one, that pieces must cover.
constexpr double kMinCover = 0.5;
// Added where segments are looked up by their midpoints.
constexpr double kRoundingPx = 0.01;

// Of a level, in pixels of the full resolution.
double PixelSize(int level) { return 1 << level; }

// A segment as axis: position along and distance across.
struct Axis {
  Vec2 origin;
  Vec2 direction;
  double length;

  Axis(const Vec2& start, const Vec2& end)
      : origin(start), length((end - start).norm()) {
    direction = length > 0 ? Vec2((end - start) / length) : Vec2(1, 0);
  }
  double Along(const Vec2& p) const { return direction.dot(p - origin); }
  double Across(const Vec2& p) const {
    const Vec2 v = p - origin;
    return direction.x() * v.y() - direction.y() * v.x();
  }
};

struct Interval {
  double low;
  double high;
};

Interval Project(const Axis& axis, const RawSegment& segment) {
  const double a = axis.Along(segment.start_px);
  const double b = axis.Along(segment.end_px);
  return {std::min(a, b), std::max(a, b)};
}

double OverlapWithAxis(const Axis& axis, const Interval& interval) {
  return std::min(interval.high, axis.length) - std::max(interval.low, 0.0);
}

bool LiesOn(const Axis& axis, const RawSegment& segment, double tolerance_px) {
  return axis.direction.dot(segment.end_px - segment.start_px) > 0 &&
         std::abs(axis.Across(segment.start_px)) <= tolerance_px &&
         std::abs(axis.Across(segment.end_px)) <= tolerance_px;
}

double UnionLength(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& a, const Interval& b) { return a.low < b.low; });
  double total = 0;
  double reached = -INFINITY;
  for (const Interval& interval : intervals) {
    const double low = std::max(interval.low, reached);
    if (interval.high > low) total += interval.high - low;
    reached = std::max(reached, interval.high);
  }
  return total;
}

// The segment along the principal axis of the end points, weighted by length,
// that spans all of them; in the polarity of the pieces.
RawSegment Span(const std::vector<RawSegment>& pieces) {
  double weight = 0;
  Vec2 mean = Vec2::Zero();
  Vec2 polarity = Vec2::Zero();
  int level = pieces.front().level;
  for (const RawSegment& piece : pieces) {
    const double w = piece.LengthPx();
    weight += 2 * w;
    mean += w * (piece.start_px + piece.end_px);
    polarity += piece.end_px - piece.start_px;
    level = std::min(level, piece.level);
  }
  mean /= weight;
  Mat2 scatter = Mat2::Zero();
  for (const RawSegment& piece : pieces) {
    for (const Vec2& p : {piece.start_px, piece.end_px}) {
      scatter += piece.LengthPx() * (p - mean) * (p - mean).transpose();
    }
  }
  Vec2 direction =
      Eigen::SelfAdjointEigenSolver<Mat2>(scatter).eigenvectors().col(1);
  if (direction.dot(polarity) < 0) direction = -direction;
  double low = INFINITY, high = -INFINITY;
  for (const RawSegment& piece : pieces) {
    for (const Vec2& p : {piece.start_px, piece.end_px}) {
      const double along = direction.dot(p - mean);
      low = std::min(low, along);
      high = std::max(high, along);
    }
  }
  return {mean + low * direction, mean + high * direction, level};
}

bool IsStraight(const RawSegment& span, const std::vector<RawSegment>& pieces) {
  const Axis axis(span.start_px, span.end_px);
  for (const RawSegment& piece : pieces) {
    const double tolerance = kStraightness * PixelSize(piece.level);
    if (!LiesOn(axis, piece, tolerance)) return false;
  }
  return true;
}

double Cover(const RawSegment& span, const std::vector<RawSegment>& pieces) {
  const Axis axis(span.start_px, span.end_px);
  std::vector<Interval> intervals;
  intervals.reserve(pieces.size());
  for (const RawSegment& piece : pieces) {
    intervals.push_back(Project(axis, piece));
  }
  return UnionLength(std::move(intervals)) / span.LengthPx();
}

// Splits pieces that lie on one guide into collinear groups: a guide may run
// between two edges that only the finer level tells apart.
std::vector<std::vector<RawSegment>> GroupCollinear(
    std::vector<RawSegment> pieces) {
  std::sort(pieces.begin(), pieces.end(), LongerFirst<RawSegment>);
  std::vector<std::vector<RawSegment>> groups;
  for (const RawSegment& piece : pieces) {
    bool placed = false;
    for (std::vector<RawSegment>& group : groups) {
      group.push_back(piece);
      placed = IsStraight(Span(group), group);
      if (placed) break;
      group.pop_back();
    }
    if (!placed) groups.push_back({piece});
  }
  return groups;
}

Vec2 Midpoint(const RawSegment& segment) {
  return 0.5 * (segment.start_px + segment.end_px);
}

MidpointGrid EmptyGrid(const std::vector<RawSegment>& segments) {
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();
  for (const RawSegment& segment : segments) {
    low = low.cwiseMin(Midpoint(segment));
    high = high.cwiseMax(Midpoint(segment));
  }
  return {low, high};
}

// Segments in the order in which they came, found by their place.
class SegmentSet {
 public:
  explicit SegmentSet(const std::vector<RawSegment>& segments)
      : grid_(EmptyGrid(segments)) {
    for (const RawSegment& segment : segments) Add(segment);
  }

  void Add(const RawSegment& segment) {
    grid_.Insert(segments_.size(), Midpoint(segment));
    segments_.push_back(segment);
    alive_.push_back(true);
  }

  // Takes out the segments that a guide covers by at least half: these have
  // their midpoints on it.
  std::vector<RawSegment> TakePieces(const RawSegment& guide) {
    const Axis axis(guide.start_px, guide.end_px);
    const double tolerance = kLateralTolerance * PixelSize(guide.level);
    std::vector<RawSegment> pieces;
    for (const std::size_t id :
         grid_.Near(guide.start_px, guide.end_px, tolerance + kRoundingPx)) {
      const RawSegment& segment = segments_[id];
      if (!alive_[id] || !LiesOn(axis, segment, tolerance) ||
          OverlapWithAxis(axis, Project(axis, segment)) <
              0.5 * segment.LengthPx()) {
        continue;
      }
      pieces.push_back(segment);
      alive_[id] = false;
    }
    return pieces;
  }

  std::vector<RawSegment> Remaining() const {
    std::vector<RawSegment> remaining;
    for (std::size_t id = 0; id < segments_.size(); ++id) {
      if (alive_[id]) remaining.push_back(segments_[id]);
    }
    return remaining;
  }

 private:
  MidpointGrid grid_;
  std::vector<RawSegment> segments_;
  std::vector<bool> alive_;
};

// Lets one coarse segment guide the merging of `segments`.
void ApplyGuide(const RawSegment& guide, SegmentSet* segments) {
  const std::vector<RawSegment> pieces = segments->TakePieces(guide);
  if (pieces.empty()) {
    segments->Add(guide);
    return;
  }
  std::vector<RawSegment> merged;
  for (const std::vector<RawSegment>& group : GroupCollinear(pieces)) {
    const RawSegment span = Span(group);
    if (group.size() > 1 && Cover(span, group) >= kMinCover) {
      merged.push_back(span);
    } else {
      merged.insert(merged.end(), group.begin(), group.end());
    }
  }
  if (Cover(guide, merged) < kMinCover) {
    // The pieces are crumbs of an edge that only the coarse level sees.
    merged = {guide};
  }
  for (const RawSegment& segment : merged) segments->Add(segment);
}

// Whether `shorter` lies on the axis of `longer`, close to it.
bool ContinuesAxis(const Axis& axis, const RawSegment& longer,
                   const RawSegment& shorter) {
  const double pixel = PixelSize(std::max(shorter.level, longer.level));
  return LiesOn(axis, shorter, 2 * kStraightness * pixel) &&
         OverlapWithAxis(axis, Project(axis, shorter)) >=
             -kMaxGapShare * shorter.LengthPx();
}

// Joins collinear neighbours, longest first.
std::vector<RawSegment> CloseGaps(std::vector<RawSegment> segments) {
  std::sort(segments.begin(), segments.end(), LongerFirst<RawSegment>);
  MidpointGrid grid = EmptyGrid(segments);
  int coarsest = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    grid.Insert(i, Midpoint(segments[i]));
    coarsest = std::max(coarsest, segments[i].level);
  }
  const double reach = 2 * kStraightness * PixelSize(coarsest) + kRoundingPx;
  std::vector<bool> used(segments.size(), false);
  std::vector<RawSegment> joined;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (used[i]) continue;
    RawSegment whole = segments[i];
    // What comes later is no longer than the first piece: its midpoint is this
    // far beyond an end of the whole at most.
    const double ahead = (0.5 + kMaxGapShare) * whole.LengthPx();
    for (bool grown = true; grown;) {
      grown = false;
      const Axis axis(whole.start_px, whole.end_px);
      for (const std::size_t j :
           grid.Near(whole.start_px - ahead * axis.direction,
                     whole.end_px + ahead * axis.direction, reach)) {
        if (j <= i || used[j] || !ContinuesAxis(axis, whole, segments[j])) {
          continue;
        }
        const std::vector<RawSegment> both = {whole, segments[j]};
        const RawSegment span = Span(both);
        if (!IsStraight(span, both)) continue;
        whole = span;
        used[j] = grown = true;
        break;
      }
    }
    joined.push_back(whole);
  }
  return joined;
}

}  // namespace

std::vector<RawSegment> MergeLevels(
    const std::vector<std::vector<RawSegment>>& levels) {
  const auto sorted = [](std::vector<RawSegment> segments) {
    std::sort(segments.begin(), segments.end(), LongerFirst<RawSegment>);
    return segments;
  };
  auto level = std::find_if(levels.begin(), levels.end(),
                            [](const auto& found) { return !found.empty(); });
  if (level == levels.end()) return {};
  SegmentSet set(sorted(*level));
  for (++level; level != levels.end(); ++level) {
    for (const RawSegment& guide : sorted(*level)) ApplyGuide(guide, &set);
  }
  return sorted(CloseGaps(set.Remaining()));
}

std::vector<std::size_t> WithoutDuplicates(
    const std::vector<RawSegment>& segments, double max_distance_px) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const bool duplicate =
        std::any_of(kept.begin(), kept.end(), [&](std::size_t k) {
          const Axis axis(segments[k].start_px, segments[k].end_px);
          return LiesOn(axis, segments[i], max_distance_px) &&
                 OverlapWithAxis(axis, Project(axis, segments[i])) >
                     0.5 * segments[i].LengthPx();
        });
    if (!duplicate) kept.push_back(i);
  }
  return kept;
}

}  // namespace lowlap
