#include "lowlap/scale/evidence/internal/coplanar_candidates.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/disc_index.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"

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

// The lines of one list that can be used, with the discs around their segments
// in the middle view.
struct UsableLines {
  std::vector<int> indices;
  std::vector<CoplanarLine> lines;
  std::vector<Disc> discs;

  int size() const { return static_cast<int>(indices.size()); }
};

UsableLines FindUsable(const RigidTransform& camn_from_camj, double focal_n_px,
                       double focal_j_px, const std::vector<MatchedLine>& lines,
                       int* num_negative) {
  UsableLines usable;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    CandidateStatus status;
    const NormalizedSegment& in_j = lines[n].in_middle.segment;
    if (!LineInMiddle(camn_from_camj, in_j, lines[n].in_neighbor.segment,
                      &status)) {
      *num_negative += status == CandidateStatus::kNegativeDepth;
      continue;
    }
    usable.indices.push_back(static_cast<int>(n));
    usable.lines.emplace_back(camn_from_camj, focal_n_px, focal_j_px, lines[n]);
    usable.discs.push_back({0.5 * (in_j.start.x() + in_j.end.x()),
                            0.5 * (in_j.start.y() + in_j.end.y()),
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

  // For each line of `first` the nearest ones of `last`, and the other way.
  void Run(const UsableLines& first, const UsableLines& last) {
    DiscIndex of_last(last.discs);
    for (int n = 0; n < first.size(); ++n) {
      Visit(first.discs[n], &of_last,
            [&](int other) { Consider(first, n, last, other); });
    }
    DiscIndex of_first(first.discs);
    for (int n = 0; n < last.size(); ++n) {
      Visit(last.discs[n], &of_first,
            [&](int other) { Consider(first, other, last, n); });
    }
  }

  std::vector<CoplanarPairCandidate> TakeResult() { return std::move(result_); }
  std::vector<PairIndex> TakeNegative() { return std::move(negative_); }

 private:
  // The nearest of `others` for a line; look(other) considers one of them.
  template <class Look>
  void Visit(const Disc& line, DiscIndex* others, const Look& look) {
    nearest_.clear();
    others->Start(line);
    for (; const auto* least = others->Front(); others->Pop()) {
      const auto& [bound, other] = *least;
      if (static_cast<int>(nearest_.size()) == num_neighbors_ &&
          bound > nearest_.back().distance_px) {
        break;
      }
      look(other);
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

  // Inserts the pair among the nearest, whose distances are normalised here.
  void Consider(const UsableLines& first, int n_first, const UsableLines& last,
                int n_last) {
    const PairIndex index{first.indices[n_first], last.indices[n_last]};
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
    pair.ratio = CoplanarRatio(first.lines[n_first], last.lines[n_last]);
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
  NeighborSearch search(geometry, lines_ij, lines_jk, num_neighbors);
  search.Run(FindUsable(geometry.cami_from_camj, geometry.focal_i_px,
                        geometry.focal_j_px, lines_ij,
                        &candidates.num_rejected_negative),
             FindUsable(geometry.camk_from_camj, geometry.focal_k_px,
                        geometry.focal_j_px, lines_jk,
                        &candidates.num_rejected_negative));

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
