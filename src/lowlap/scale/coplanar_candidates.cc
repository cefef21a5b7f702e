#include "lowlap/scale/coplanar_candidates.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "lowlap/scale/coplanar_ratio.h"
#include "lowlap/scale/trifocal_line.h"

namespace lowlap {
namespace {

double PointSegmentDistance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double along =
      length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - along * ab).norm();
}

// From the crossing of two lines to the farther of the two segments.
double CrossingDistance(const NormalizedSegment& a,
                        const NormalizedSegment& b) {
  const std::optional<Vec3> x = CrossingInMiddle(a, b);
  if (!x) return std::numeric_limits<double>::infinity();
  const auto to = [&](const NormalizedSegment& segment) {
    return PointSegmentDistance(x->head<2>(), segment.start.head<2>(),
                                segment.end.head<2>());
  };
  return std::max(to(a), to(b));
}

double Cross2(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// A line that can be used, with the disc around its segment in the middle view.
struct UsableLine {
  int index = 0;
  Vec2 center = Vec2::Zero();
  double radius = 0;
};

std::vector<UsableLine> UsableLines(const RigidTransform& camn_from_camj,
                                    const std::vector<MatchedLine>& lines,
                                    int* num_negative) {
  std::vector<UsableLine> usable;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    CandidateStatus status;
    const NormalizedSegment& in_j = lines[n].in_middle.segment;
    if (!LineInMiddle(camn_from_camj, in_j, lines[n].in_neighbor.segment,
                      &status)) {
      *num_negative += status == CandidateStatus::kNegativeDepth;
      continue;
    }
    usable.push_back({static_cast<int>(n),
                      0.5 * (in_j.start + in_j.end).head<2>(),
                      0.5 * (in_j.end - in_j.start).head<2>().norm()});
  }
  return usable;
}

using PairIndex = std::pair<int, int>;

class NeighborSearch {
 public:
  NeighborSearch(const TripletGeometry& geometry,
                 const std::vector<MatchedLine>& lines_ij,
                 const std::vector<MatchedLine>& lines_jk, int num_neighbors)
      : geometry_(geometry),
        lines_ij_(lines_ij),
        lines_jk_(lines_jk),
        num_neighbors_(num_neighbors) {}

  // The nearest lines of `others` for one line of the other list.
  void Visit(const UsableLine& line, bool line_is_first,
             const std::vector<UsableLine>& others) {
    bounds_.clear();
    for (std::size_t n = 0; n < others.size(); ++n) {
      const double bound = (others[n].center - line.center).norm() -
                           others[n].radius - line.radius;
      bounds_.emplace_back(bound, static_cast<int>(n));
    }
    const auto later = std::greater<std::pair<double, int>>();
    std::make_heap(bounds_.begin(), bounds_.end(), later);
    nearest_.clear();
    while (!bounds_.empty()) {
      const auto [bound, n] = bounds_.front();
      if (static_cast<int>(nearest_.size()) == num_neighbors_ &&
          bound > nearest_.back().distance_px) {
        break;
      }
      std::pop_heap(bounds_.begin(), bounds_.end(), later);
      bounds_.pop_back();
      Consider(line_is_first ? PairIndex{line.index, others[n].index}
                             : PairIndex{others[n].index, line.index});
    }
    for (CoplanarPairCandidate& pair : nearest_) {
      pair.distance_px *= geometry_.focal_j_px;
      pair.crossing_px =
          geometry_.focal_j_px *
          CrossingDistance(lines_ij_[pair.first].in_middle.segment,
                           lines_jk_[pair.last].in_middle.segment);
      result_.push_back(pair);
    }
  }

  std::vector<CoplanarPairCandidate> TakeResult() { return std::move(result_); }
  std::vector<PairIndex> TakeNegative() { return std::move(negative_); }

 private:
  // Inserts the pair among the nearest, whose distances are normalised here.
  void Consider(const PairIndex& index) {
    const MatchedLine& a = lines_ij_[index.first];
    const MatchedLine& b = lines_jk_[index.second];
    if (a.segment_in_middle == b.segment_in_middle) return;
    CoplanarPairCandidate pair;
    pair.first = index.first;
    pair.last = index.second;
    pair.distance_px =
        SegmentDistance(a.in_middle.segment, b.in_middle.segment);
    const bool is_full = static_cast<int>(nearest_.size()) == num_neighbors_;
    if (is_full && pair.distance_px > nearest_.back().distance_px) return;
    pair.ratio = CoplanarRatio(geometry_, a, b);
    if (pair.ratio.status == CandidateStatus::kNegativeDepth) {
      negative_.push_back(index);
    }
    if (pair.ratio.status != CandidateStatus::kValid) return;
    // Crossing segments are all at distance 0: the better ratio goes first.
    const auto nearer = [](const CoplanarPairCandidate& p,
                           const CoplanarPairCandidate& q) {
      return std::tie(p.distance_px, p.ratio.log_ratio_stddev) <
             std::tie(q.distance_px, q.ratio.log_ratio_stddev);
    };
    nearest_.insert(
        std::upper_bound(nearest_.begin(), nearest_.end(), pair, nearer), pair);
    if (static_cast<int>(nearest_.size()) > num_neighbors_) {
      nearest_.pop_back();
    }
  }

  const TripletGeometry& geometry_;
  const std::vector<MatchedLine>& lines_ij_;
  const std::vector<MatchedLine>& lines_jk_;
  const int num_neighbors_;
  std::vector<std::pair<double, int>> bounds_;  // a heap, least bound first
  std::vector<CoplanarPairCandidate> nearest_;
  std::vector<CoplanarPairCandidate> result_;
  std::vector<PairIndex> negative_;
};

}  // namespace

double SegmentDistance(const NormalizedSegment& a, const NormalizedSegment& b) {
  const Vec2 a1 = a.start.head<2>(), a2 = a.end.head<2>();
  const Vec2 b1 = b.start.head<2>(), b2 = b.end.head<2>();
  const bool a_straddles =
      Cross2(b2 - b1, a1 - b1) * Cross2(b2 - b1, a2 - b1) < 0;
  const bool b_straddles =
      Cross2(a2 - a1, b1 - a1) * Cross2(a2 - a1, b2 - a1) < 0;
  if (a_straddles && b_straddles) return 0.0;
  return std::min(
      {PointSegmentDistance(a1, b1, b2), PointSegmentDistance(a2, b1, b2),
       PointSegmentDistance(b1, a1, a2), PointSegmentDistance(b2, a1, a2)});
}

CoplanarPairCandidates FindCoplanarCandidates(
    const TripletGeometry& geometry, const std::vector<MatchedLine>& lines_ij,
    const std::vector<MatchedLine>& lines_jk, int num_neighbors) {
  CoplanarPairCandidates candidates;
  const std::vector<UsableLine> first = UsableLines(
      geometry.cami_from_camj, lines_ij, &candidates.num_rejected_negative);
  const std::vector<UsableLine> last = UsableLines(
      geometry.camk_from_camj, lines_jk, &candidates.num_rejected_negative);
  NeighborSearch search(geometry, lines_ij, lines_jk, num_neighbors);
  for (const UsableLine& line : first) search.Visit(line, true, last);
  for (const UsableLine& line : last) search.Visit(line, false, first);

  candidates.pairs = search.TakeResult();
  const auto key = [](const CoplanarPairCandidate& pair) {
    return PairIndex{pair.first, pair.last};
  };
  std::sort(candidates.pairs.begin(), candidates.pairs.end(),
            [&](const CoplanarPairCandidate& p,
                const CoplanarPairCandidate& q) { return key(p) < key(q); });
  candidates.pairs.erase(
      std::unique(
          candidates.pairs.begin(), candidates.pairs.end(),
          [&](const CoplanarPairCandidate& p, const CoplanarPairCandidate& q) {
            return key(p) == key(q);
          }),
      candidates.pairs.end());
  std::vector<PairIndex> negative = search.TakeNegative();
  std::sort(negative.begin(), negative.end());
  candidates.num_rejected_negative += static_cast<int>(
      std::unique(negative.begin(), negative.end()) - negative.begin());
  return candidates;
}

}  // namespace lowlap
