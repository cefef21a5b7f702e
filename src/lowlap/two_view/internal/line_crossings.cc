#include "lowlap/two_view/internal/line_crossings.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace lowlap {
namespace {

constexpr double kMinAngleDeg = 20;
constexpr double kReachOfLength = 0.05;
constexpr double kReachOfFocal = 0.01;
constexpr int kMaxPerMatch = 4;

// How far from its ends a segment may be crossed.
double ReachOf(double length) {
  return kReachOfLength * length + kReachOfFocal;
}

// How far a point of its support line lies beyond the segment's ends; 0 inside.
double Beyond(const NormalizedSegment& s, const Vec2& point) {
  const Vec2 start = s.start.head<2>();
  const Vec2 along = s.end.head<2>() - start;
  const double length = along.norm();
  const double position = (point - start).dot(along) / length;
  return std::max({0.0, -position, position - length});
}

// Variance of the support line at a point of it; 1 at the ends.
double VarianceAt(const NormalizedSegment& s, const Vec2& point) {
  const Vec2 along = (s.end - s.start).head<2>();
  const double share =
      (point - s.start.head<2>()).dot(along) / along.squaredNorm();
  return (1 - share) * (1 - share) + share * share;
}

struct Crossing {
  Vec3 point;
  Mat2 covariance;
  double gap;  // the larger distance to the two segments
};

std::optional<Crossing> Cross(const NormalizedSegment& a,
                              const NormalizedSegment& b) {
  if (!a.IsValid() || !b.IsValid()) return std::nullopt;
  const Vec2 along_a = (a.end - a.start).head<2>();
  const Vec2 along_b = (b.end - b.start).head<2>();
  const double length_a = along_a.norm(), length_b = along_b.norm();
  const double sine = (along_a.x() * along_b.y() - along_a.y() * along_b.x()) /
                      (length_a * length_b);
  if (std::abs(sine) < std::sin(RadFromDeg(kMinAngleDeg))) return std::nullopt;
  const Vec3 x = a.normal.cross(b.normal);
  const Vec2 point = x.head<2>() / x.z();
  const double gap_a = Beyond(a, point), gap_b = Beyond(b, point);
  if (gap_a > ReachOf(length_a) || gap_b > ReachOf(length_b)) {
    return std::nullopt;
  }
  // Both lines hold the point across themselves: N dx = (e_a, e_b).
  Mat2 normals;
  normals << -along_a.y() / length_a, along_a.x() / length_a,
      -along_b.y() / length_b, along_b.x() / length_b;
  const Mat2 inverse = normals.inverse();
  const Mat2 covariance =
      inverse * Vec2(VarianceAt(a, point), VarianceAt(b, point)).asDiagonal() *
      inverse.transpose();
  return Crossing{
      {point.x(), point.y(), 1}, covariance, std::max(gap_a, gap_b)};
}

// What holds every point where a segment may be crossed.
struct Box {
  std::size_t match;
  Vec2 low, high;
};

// Couples of matches, the first first, whose boxes in the first view overlap.
template <class Visit>
void ForEachNeighbors(const NormalizedFeatures& features1,
                      const std::vector<FeatureMatch>& line_matches,
                      const Visit& visit) {
  std::vector<Box> boxes;
  for (std::size_t n = 0; n < line_matches.size(); ++n) {
    const NormalizedSegment& s = features1.segments[line_matches[n].first];
    if (!s.IsValid()) continue;
    const Vec2 start = s.start.head<2>(), end = s.end.head<2>();
    // A little more, for what rounding does.
    const double reach = 1e-6 + ReachOf((end - start).norm());
    boxes.push_back({n, start.cwiseMin(end).array() - reach,
                     start.cwiseMax(end).array() + reach});
  }
  std::sort(boxes.begin(), boxes.end(),
            [](const Box& p, const Box& q) { return p.low.x() < q.low.x(); });
  for (auto p = boxes.begin(); p != boxes.end(); ++p) {
    for (auto q = p + 1; q != boxes.end() && q->low.x() <= p->high.x(); ++q) {
      if (q->low.y() > p->high.y() || q->high.y() < p->low.y()) continue;
      visit(std::min(p->match, q->match), std::max(p->match, q->match));
    }
  }
}

}  // namespace

std::vector<LineCrossing> FindLineCrossings(
    const NormalizedFeatures& features1, const NormalizedFeatures& features2,
    const std::vector<FeatureMatch>& line_matches) {
  struct Candidate {
    double gap;
    double variance;  // of the crossing, in both views together
    std::size_t a, b;
    LineCrossing crossing;
  };
  std::vector<Candidate> candidates;
  ForEachNeighbors(features1, line_matches, [&](std::size_t a, std::size_t b) {
    const FeatureMatch &ma = line_matches[a], &mb = line_matches[b];
    const auto in1 =
        Cross(features1.segments[ma.first], features1.segments[mb.first]);
    if (!in1) return;
    const auto in2 =
        Cross(features2.segments[ma.second], features2.segments[mb.second]);
    if (!in2) return;
    candidates.push_back(
        {std::max(in1->gap * features1.focal_px, in2->gap * features2.focal_px),
         in1->covariance.trace() + in2->covariance.trace(),
         a,
         b,
         {in1->point,
          in2->point,
          in1->covariance,
          in2->covariance,
          {static_cast<int>(a), static_cast<int>(b)}}});
  });
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& p, const Candidate& q) {
              return std::tie(p.gap, p.variance, p.a, p.b) <
                     std::tie(q.gap, q.variance, q.a, q.b);
            });
  std::vector<int> uses(line_matches.size(), 0);
  std::vector<Candidate> kept;
  for (const Candidate& c : candidates) {
    if (uses[c.a] == kMaxPerMatch || uses[c.b] == kMaxPerMatch) continue;
    ++uses[c.a];
    ++uses[c.b];
    kept.push_back(c);
  }
  std::sort(kept.begin(), kept.end(),
            [](const Candidate& p, const Candidate& q) {
              return std::tie(p.a, p.b) < std::tie(q.a, q.b);
            });
  std::vector<LineCrossing> crossings;
  crossings.reserve(kept.size());
  for (const Candidate& c : kept) crossings.push_back(c.crossing);
  return crossings;
}

}  // namespace lowlap
