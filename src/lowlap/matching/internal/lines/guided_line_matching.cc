#include "lowlap/matching/internal/lines/guided_line_matching.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/matching/internal/lines/line_candidates.h"
#include "lowlap/matching/internal/lines/line_transfer.h"

namespace lowlap {
namespace {

constexpr std::size_t kGuidedNeighbors = 10;
constexpr int kGuidedIterations = 5;
// Two neighbours at a distance s in the image (in focal lengths) agree if their
// logarithmic depths differ by less than about kDepthNoise + kDepthSlope s: on
// one surface, seen at an angle.
constexpr double kDepthNoise = 0.03;
constexpr double kDepthSlope = 1.0;
// The mean support that gives a candidate half of the highest score.
constexpr double kGuidedHalfSupport = 0.15;
// What a match found without the pose is worth more than a new one.
constexpr double kSeedBonus = 0.2;

// A match is made only if no contradicting candidate scores more than this
// share of its score.
constexpr double kGuidedMaxRivalShare = 0.85;

struct GuidedCandidate {
  FeatureMatch match;
  LineTransfer transfer;
  double similarity = 0;  // in [0, 1]

  // The inverse of the depth at unit offset.
  double Steepness(const Vec2& at) const {
    return std::abs(transfer.plane.dot(Vec3(at.x(), at.y(), 1)));
  }
  double LogDepth(const Vec2& at) const {
    return std::log(std::abs(transfer.offset) / Steepness(at));
  }
};

struct Neighbor {
  std::size_t segment = 0;
  double distance = 0;        // in focal lengths
  Vec2 here = Vec2::Zero();   // closest point of the segment itself
  Vec2 there = Vec2::Zero();  // and of its neighbour
};

Vec2 ClosestOnSegment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return a + t * d;
}

Neighbor ClosestPoints(const NormalizedSegment& s, const NormalizedSegment& o) {
  const Vec2 a = s.start.head<2>(), b = s.end.head<2>();
  const Vec2 c = o.start.head<2>(), d = o.end.head<2>();
  Neighbor closest;
  const Vec3 crossing = s.normal.cross(o.normal);
  if (std::abs(crossing.z()) > 1e-9) {
    const Vec2 x = crossing.hnormalized();
    if ((x - a).dot(x - b) <= 0 && (x - c).dot(x - d) <= 0) {
      closest.here = closest.there = x;
      return closest;
    }
  }
  closest.distance = INFINITY;
  const auto take = [&](const Vec2& here, const Vec2& there) {
    const double distance = (here - there).norm();
    if (distance >= closest.distance) return;
    closest.distance = distance;
    closest.here = here;
    closest.there = there;
  };
  take(a, ClosestOnSegment(a, c, d));
  take(b, ClosestOnSegment(b, c, d));
  take(ClosestOnSegment(c, a, b), c);
  take(ClosestOnSegment(d, a, b), d);
  return closest;
}

double EpipolarSlack(const NormalizedFeatures& first,
                     const NormalizedFeatures& second,
                     const GuidedLineOptions& options) {
  return options.epipolar_tolerance_px /
         std::min(first.focal_px, second.focal_px);
}

std::vector<GuidedCandidate> CollectGuidedCandidates(
    const DescribedLines& first, const DescribedLines& second,
    const NormalizedFeatures& normalized1,
    const NormalizedFeatures& normalized2, const RigidTransform& cam2_from_cam1,
    const std::vector<FeatureMatch>& seeds, const GuidedLineOptions& options) {
  std::vector<FeatureMatch> sorted_seeds = seeds;
  std::sort(sorted_seeds.begin(), sorted_seeds.end());
  const double min_sine = std::sin(RadFromDeg(options.min_epipolar_angle_deg));
  const double slack = EpipolarSlack(normalized1, normalized2, options);
  std::vector<GuidedCandidate> candidates;
  auto seed = sorted_seeds.begin();
  std::vector<int> distances;
  for (std::size_t i = 0; i < first.segments.size(); ++i) {
    HammingDistances(first.descriptors[i], second.descriptors, &distances);
    for (std::size_t j = 0; j < second.segments.size(); ++j) {
      const FeatureMatch match = {static_cast<FeatureIndex>(i),
                                  static_cast<FeatureIndex>(j)};
      while (seed != sorted_seeds.end() && *seed < match) ++seed;
      const bool is_seed = seed != sorted_seeds.end() && *seed == match;
      const int distance = distances[j];
      if (!is_seed && distance > options.max_distance_bits) continue;
      const auto transfer =
          TransferLine(normalized1.segments[i], normalized2.segments[j],
                       cam2_from_cam1, min_sine, slack);
      if (!transfer || !transfer->same_polarity ||
          transfer->overlap_of_shorter < options.min_overlap) {
        continue;
      }
      GuidedCandidate candidate;
      candidate.match = match;
      candidate.transfer = *transfer;
      candidate.similarity =
          std::max(0.0, 1 - distance / (1.0 + options.max_distance_bits)) *
          (0.5 + 0.5 * transfer->overlap_of_longer);
      if (is_seed) candidate.similarity += kSeedBonus;
      candidate.similarity = std::min(1.0, candidate.similarity);
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

std::vector<std::vector<Neighbor>> FindGuidedNeighbors(
    const NormalizedFeatures& features,
    const std::vector<std::vector<std::size_t>>& candidates_of) {
  const std::vector<NormalizedSegment>& segments = features.segments;
  std::vector<std::vector<Neighbor>> neighbors(segments.size());
  const auto nearer = [](const Neighbor& a, const Neighbor& b) {
    return a.distance != b.distance ? a.distance < b.distance
                                    : a.segment < b.segment;
  };
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (candidates_of[i].empty()) continue;
    std::vector<Neighbor>& list = neighbors[i];
    const Vec3 middle = segments[i].start + segments[i].end;
    const double length = (segments[i].end - segments[i].start).norm();
    for (std::size_t j = 0; j < segments.size(); ++j) {
      if (j == i || candidates_of[j].empty()) continue;
      // No closer than the midpoints less half of both lengths.
      if (list.size() == kGuidedNeighbors) {
        const double reach = 2 * list.back().distance + length +
                             (segments[j].end - segments[j].start).norm();
        if ((segments[j].start + segments[j].end - middle).norm() > reach) {
          continue;
        }
      }
      Neighbor neighbor = ClosestPoints(segments[i], segments[j]);
      neighbor.segment = j;
      list.insert(std::upper_bound(list.begin(), list.end(), neighbor, nearer),
                  neighbor);
      if (list.size() > kGuidedNeighbors) list.pop_back();
    }
  }
  return neighbors;
}

std::vector<ScoredMatch> RelaxGuided(
    const NormalizedFeatures& first, double slack,
    const std::vector<GuidedCandidate>& candidates) {
  std::vector<std::vector<std::size_t>> candidates_of(first.segments.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    candidates_of[candidates[c].match.first].push_back(c);
  }
  const auto neighbors = FindGuidedNeighbors(first, candidates_of);
  std::vector<std::vector<std::vector<Support>>> supports(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const GuidedCandidate& candidate = candidates[c];
    for (const Neighbor& n : neighbors[candidate.match.first]) {
      std::vector<Support> list;
      const double surface = kDepthNoise + kDepthSlope * n.distance;
      const double log_depth = candidate.LogDepth(n.here);
      for (const std::size_t o : candidates_of[n.segment]) {
        const GuidedCandidate& other = candidates[o];
        const double tolerance =
            std::hypot(surface, slack / candidate.Steepness(n.here),
                       slack / other.Steepness(n.there));
        const double u = (log_depth - other.LogDepth(n.there)) / tolerance;
        const double agreement = std::exp(-0.5 * u * u);
        if (agreement > 0.01) list.push_back({o, agreement * other.similarity});
      }
      supports[c].push_back(std::move(list));
    }
  }
  std::vector<double> scores;
  scores.reserve(candidates.size());
  for (const GuidedCandidate& c : candidates) scores.push_back(c.similarity);
  scores = RelaxScores(std::move(scores), supports, kGuidedHalfSupport,
                       kGuidedIterations);
  std::vector<ScoredMatch> scored;
  for (std::size_t c = 0; c < scores.size(); ++c) {
    scored.push_back(
        {candidates[c].match, scores[c] * candidates[c].similarity});
  }
  return scored;
}

// Best first; a segment goes to all pieces of one edge.
std::vector<FeatureMatch> Assign(const DescribedLines& first,
                                 const DescribedLines& second,
                                 const std::vector<FeatureMatch>& decided) {
  std::vector<std::vector<FeatureIndex>> partners1(first.segments.size());
  std::vector<std::vector<FeatureIndex>> partners2(second.segments.size());
  const auto fits = [](const std::vector<LineSegment>& segments,
                       FeatureIndex piece,
                       const std::vector<FeatureIndex>& others) {
    return std::all_of(others.begin(), others.end(), [&](FeatureIndex other) {
      return ArePieces(segments[piece], segments[other]);
    });
  };
  std::vector<FeatureMatch> matches;
  for (const FeatureMatch& match : decided) {
    if (!fits(second.segments, match.second, partners1[match.first]) ||
        !fits(first.segments, match.first, partners2[match.second])) {
      continue;
    }
    partners1[match.first].push_back(match.second);
    partners2[match.second].push_back(match.first);
    matches.push_back(match);
  }
  std::sort(matches.begin(), matches.end());
  return matches;
}

}  // namespace

Status GuidedLineOptions::Validate() const {
  return Require({{max_distance_bits >= 0 && max_distance_bits <= 256,
                   "max_distance_bits must lie in [0, 256]"},
                  {min_overlap >= 0 && min_overlap <= 1,
                   "min_overlap of lines must lie in [0, 1]"},
                  {min_epipolar_angle_deg >= 0 && min_epipolar_angle_deg < 90,
                   "min_epipolar_angle_deg must lie in [0, 90)"},
                  {epipolar_tolerance_px >= 0,
                   "epipolar_tolerance_px must not be negative"},
                  {min_score >= 0 && min_score <= 1,
                   "min_score of lines must lie in [0, 1]"}});
}

std::vector<FeatureMatch> MatchLinesGuided(
    const DescribedLines& first, const DescribedLines& second,
    const NormalizedFeatures& first_normalized,
    const NormalizedFeatures& second_normalized,
    const RigidTransform& cam2_from_cam1,
    const std::vector<FeatureMatch>& seeds, const GuidedLineOptions& options) {
  const std::vector<GuidedCandidate> candidates = CollectGuidedCandidates(
      first, second, first_normalized, second_normalized, cam2_from_cam1, seeds,
      options);
  if (candidates.empty()) return {};
  const double slack =
      EpipolarSlack(first_normalized, second_normalized, options);
  return Assign(first, second,
                DecidedMatches(first.segments, second.segments,
                               RelaxGuided(first_normalized, slack, candidates),
                               options.min_score, kGuidedMaxRivalShare));
}

}  // namespace lowlap
