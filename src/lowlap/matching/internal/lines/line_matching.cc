#include "lowlap/matching/internal/lines/line_matching.h"

#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/matching/internal/lines/line_candidates.h"

namespace lowlap {
namespace {

constexpr int kNeighbors = 12;
constexpr int kIterations = 6;
// Two neighbouring matches agree if they turn by angles that differ less,
constexpr double kMaxTurnDifferenceRad = 0.6;
// and if their distance changes by less than this factor.
constexpr double kMaxDistanceRatio = 2.5;
// The mean support that gives a match half of the highest score. A match
// keeps a score through the iterations only if its neighbours support it by
// about this much; measured on rooms and facades.
constexpr double kHalfSupport = 0.07;
// Closer to a line than this, the side says nothing.
constexpr double kSideTolerancePx = 4.0;

// A match is made only if no contradicting candidate scores more than this
// share of its score.
constexpr double kMaxRivalShare = 0.9;

struct Candidate {
  FeatureMatch match;
  double similarity = 0;  // of the descriptors, in (0, 1]
};

Vec2 Middle(const LineSegment& s) { return 0.5 * (s.start_px + s.end_px); }

double AngleOf(const LineSegment& s) {
  const Vec2 d = s.end_px - s.start_px;
  return std::atan2(d.y(), d.x());
}

double SignedDistance(const Vec2& point, const LineSegment& s) {
  const Vec2 d = (s.end_px - s.start_px).normalized();
  const Vec2 v = point - s.start_px;
  return d.x() * v.y() - d.y() * v.x();
}

bool SidesContradict(const LineSegment& a, const Vec2& c, const LineSegment& b,
                     const Vec2& d) {
  const double side1 = SignedDistance(c, a), side2 = SignedDistance(d, b);
  return std::abs(side1) > kSideTolerancePx &&
         std::abs(side2) > kSideTolerancePx && (side1 > 0) != (side2 > 0);
}

// How well the matches a -> b and c -> d go together, in [0, 1].
double Agreement(const LineSegment& a, const LineSegment& b,
                 const LineSegment& c, const LineSegment& d) {
  const double turn = std::remainder(
      (AngleOf(b) - AngleOf(a)) - (AngleOf(d) - AngleOf(c)), 2 * kPi);
  if (std::abs(turn) >= kMaxTurnDifferenceRad) return 0;
  const Vec2 ma = Middle(a), mb = Middle(b), mc = Middle(c), md = Middle(d);
  if (SidesContradict(a, mc, b, md) || SidesContradict(c, ma, d, mb)) return 0;
  const double distance1 = (ma - mc).norm() + kSideTolerancePx;
  const double distance2 = (mb - md).norm() + kSideTolerancePx;
  const double ratio = std::abs(std::log(distance1 / distance2));
  const double max_ratio = std::log(kMaxDistanceRatio);
  if (ratio >= max_ratio) return 0;
  return (1 - std::abs(turn) / kMaxTurnDifferenceRad) * (1 - ratio / max_ratio);
}

// Pairs that are among the max_candidates nearest of both their segments.
std::vector<Candidate> CollectCandidates(const DescribedLines& first,
                                         const DescribedLines& second,
                                         const LineMatchOptions& options) {
  struct ByDistance {
    int distance;
    FeatureIndex index;
    bool operator<(const ByDistance& o) const {
      return distance != o.distance ? distance < o.distance : index < o.index;
    }
  };
  const std::size_t n1 = first.segments.size(), n2 = second.segments.size();
  const auto keep = static_cast<std::size_t>(options.max_candidates);
  const auto insert = [&](std::vector<ByDistance>* list, ByDistance nearest) {
    if (list->size() == keep && !(nearest < list->back())) return;
    list->insert(std::upper_bound(list->begin(), list->end(), nearest),
                 nearest);
    if (list->size() > keep) list->pop_back();
  };
  std::vector<std::vector<ByDistance>> forward(n1), backward(n2);
  std::vector<int> distances;
  for (std::size_t i = 0; i < n1; ++i) {
    const double length1 = first.segments[i].LengthPx();
    HammingDistances(first.descriptors[i], second.descriptors, &distances);
    for (std::size_t j = 0; j < n2; ++j) {
      const int distance = distances[j];
      if (distance > options.max_distance_bits) continue;
      const double length2 = second.segments[j].LengthPx();
      if (std::max(length1, length2) >
          options.max_length_ratio * std::min(length1, length2)) {
        continue;
      }
      insert(&forward[i], {distance, static_cast<FeatureIndex>(j)});
      insert(&backward[j], {distance, static_cast<FeatureIndex>(i)});
    }
  }
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < n1; ++i) {
    for (const ByDistance& nearest : forward[i]) {
      const std::vector<ByDistance>& back = backward[nearest.index];
      const bool mutual =
          std::any_of(back.begin(), back.end(),
                      [&](const ByDistance& n) { return n.index == i; });
      if (!mutual) continue;
      Candidate candidate;
      candidate.match = {static_cast<FeatureIndex>(i), nearest.index};
      candidate.similarity =
          1 - nearest.distance / (1.0 + options.max_distance_bits);
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

// For every segment, the nearest others that have candidates, by midpoint.
std::vector<std::vector<std::size_t>> FindNeighbors(
    const std::vector<LineSegment>& segments,
    const std::vector<std::vector<std::size_t>>& candidates_of) {
  std::vector<std::vector<std::size_t>> neighbors(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (candidates_of[i].empty()) continue;
    std::vector<std::pair<double, std::size_t>> others;
    for (std::size_t j = 0; j < segments.size(); ++j) {
      if (j == i || candidates_of[j].empty()) continue;
      others.emplace_back(
          (Middle(segments[i]) - Middle(segments[j])).squaredNorm(), j);
    }
    const std::size_t count = std::min<std::size_t>(kNeighbors, others.size());
    std::partial_sort(others.begin(),
                      others.begin() + static_cast<std::ptrdiff_t>(count),
                      others.end());
    for (std::size_t k = 0; k < count; ++k) {
      neighbors[i].push_back(others[k].second);
    }
  }
  return neighbors;
}

// Scores the candidates by relaxation: a neighbour weighs by its similarity and
// by how well it agrees.
std::vector<ScoredMatch> Relax(const DescribedLines& first,
                               const DescribedLines& second,
                               const std::vector<Candidate>& candidates) {
  std::vector<std::vector<std::size_t>> candidates_of(first.segments.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    candidates_of[candidates[c].match.first].push_back(c);
  }
  const auto neighbors = FindNeighbors(first.segments, candidates_of);
  // For every candidate, one list per neighbour.
  std::vector<std::vector<std::vector<Support>>> supports(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const FeatureMatch& m = candidates[c].match;
    for (const std::size_t n : neighbors[m.first]) {
      std::vector<Support> list;
      for (const std::size_t other : candidates_of[n]) {
        const FeatureMatch& o = candidates[other].match;
        if (o.second == m.second) continue;
        const double agreement =
            Agreement(first.segments[m.first], second.segments[m.second],
                      first.segments[o.first], second.segments[o.second]);
        if (agreement > 0) {
          list.push_back({other, agreement * candidates[other].similarity});
        }
      }
      supports[c].push_back(std::move(list));
    }
  }
  std::vector<double> scores;
  scores.reserve(candidates.size());
  for (const Candidate& c : candidates) scores.push_back(c.similarity);
  scores = RelaxScores(std::move(scores), supports, kHalfSupport, kIterations);
  std::vector<ScoredMatch> scored;
  for (std::size_t c = 0; c < scores.size(); ++c) {
    scored.push_back({candidates[c].match, scores[c]});
  }
  return scored;
}

}  // namespace

Status LineMatchOptions::Validate() const {
  return Require(
      {{max_distance_bits >= 0 && max_distance_bits <= 256,
        "max_distance_bits must lie in [0, 256]"},
       {max_candidates >= 1, "max_candidates must be at least 1"},
       {min_score >= 0 && min_score <= 1,
        "min_score of lines must lie in [0, 1]"},
       {max_length_ratio >= 1, "max_length_ratio must be at least 1"}});
}

std::vector<FeatureMatch> MatchLines(const DescribedLines& first,
                                     const DescribedLines& second,
                                     const LineMatchOptions& options) {
  const std::vector<Candidate> candidates =
      CollectCandidates(first, second, options);
  if (candidates.empty()) return {};
  std::vector<bool> used1(first.segments.size()), used2(second.segments.size());
  std::vector<FeatureMatch> matches;
  for (const FeatureMatch& match : DecidedMatches(
           first.segments, second.segments, Relax(first, second, candidates),
           options.min_score, kMaxRivalShare)) {
    if (used1[match.first] || used2[match.second]) continue;
    used1[match.first] = used2[match.second] = true;
    matches.push_back(match);
  }
  std::sort(matches.begin(), matches.end());
  return matches;
}

}  // namespace lowlap
