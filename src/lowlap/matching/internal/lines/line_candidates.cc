#include "lowlap/matching/internal/lines/line_candidates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <utility>

namespace lowlap {
namespace {

// For every match the best score of a rival; 0 without one.
std::vector<double> FindRivals(const std::vector<LineSegment>& first,
                               const std::vector<LineSegment>& second,
                               const std::vector<ScoredMatch>& by_score) {
  std::vector<std::vector<std::size_t>> of1(first.size());
  std::vector<std::vector<std::size_t>> of2(second.size());
  for (std::size_t c = 0; c < by_score.size(); ++c) {
    of1[by_score[c].match.first].push_back(c);
    of2[by_score[c].match.second].push_back(c);
  }
  std::vector<double> rivals(by_score.size(), 0);
  for (std::size_t c = 0; c < by_score.size(); ++c) {
    const FeatureMatch& m = by_score[c].match;
    for (const std::size_t o : of1[m.first]) {
      if (o == c ||
          ArePieces(second[m.second], second[by_score[o].match.second])) {
        continue;
      }
      rivals[c] = by_score[o].score;
      break;
    }
    for (const std::size_t o : of2[m.second]) {
      if (o == c || ArePieces(first[m.first], first[by_score[o].match.first])) {
        continue;
      }
      rivals[c] = std::max(rivals[c], by_score[o].score);
      break;
    }
  }
  return rivals;
}

}  // namespace

void HammingDistances(const LineDescriptor& query,
                      const std::vector<LineDescriptor>& others,
                      std::vector<int>* distances) {
  distances->resize(others.size());
  if (others.empty()) return;
  // Views; OpenCV has no const matrix.
  const int length = static_cast<int>(query.size());
  const int count = static_cast<int>(others.size());
  const cv::Mat one(1, length, CV_8U, const_cast<std::uint8_t*>(query.data()));
  const cv::Mat all(count, length, CV_8U,
                    const_cast<std::uint8_t*>(others.front().data()));
  cv::Mat result(1, count, CV_32S, distances->data());
  cv::batchDistance(one, all, result, CV_32S, cv::noArray(), cv::NORM_HAMMING,
                    0);
}

std::vector<double> RelaxScores(
    std::vector<double> scores,
    const std::vector<std::vector<std::vector<Support>>>& supports,
    double half_support, int iterations) {
  for (int iteration = 0; iteration < iterations; ++iteration) {
    std::vector<double> next(scores.size(), 0);
    for (std::size_t c = 0; c < scores.size(); ++c) {
      if (supports[c].empty()) continue;
      double sum = 0;
      for (const std::vector<Support>& list : supports[c]) {
        double best = 0;
        for (const Support& s : list) {
          best = std::max(best, s.weight * scores[s.candidate]);
        }
        sum += best;
      }
      const double support = sum / static_cast<double>(supports[c].size());
      next[c] = support / (support + half_support);
    }
    scores = std::move(next);
  }
  return scores;
}

bool ArePieces(const LineSegment& a, const LineSegment& b) {
  constexpr double kMaxDistancePx = 2.0;
  constexpr double kMaxOverlap = 0.1;
  const LineSegment& longer = a.LengthPx() >= b.LengthPx() ? a : b;
  const LineSegment& shorter = a.LengthPx() >= b.LengthPx() ? b : a;
  const double length = longer.LengthPx();
  const Vec2 d = (longer.end_px - longer.start_px) / length;
  const Vec2 start = shorter.start_px - longer.start_px;
  const Vec2 end = shorter.end_px - longer.start_px;
  const double low = d.dot(start), high = d.dot(end);
  if (low >= high) return false;
  const auto across = [&](const Vec2& v) {
    return std::abs(d.x() * v.y() - d.y() * v.x());
  };
  // A short piece far away on the axis may be off by its own share of noise.
  if (std::max(across(start), across(end)) > kMaxDistancePx) return false;
  return std::min(high, length) - std::max(low, 0.0) <
         kMaxOverlap * shorter.LengthPx();
}

std::vector<FeatureMatch> DecidedMatches(const std::vector<LineSegment>& first,
                                         const std::vector<LineSegment>& second,
                                         std::vector<ScoredMatch> matches,
                                         double min_score,
                                         double max_rival_share) {
  std::sort(matches.begin(), matches.end(),
            [](const ScoredMatch& a, const ScoredMatch& b) {
              return a.score != b.score ? a.score > b.score : a.match < b.match;
            });
  const std::vector<double> rivals = FindRivals(first, second, matches);
  std::vector<FeatureMatch> decided;
  for (std::size_t n = 0; n < matches.size(); ++n) {
    if (matches[n].score < min_score) break;
    if (rivals[n] > max_rival_share * matches[n].score) continue;
    decided.push_back(matches[n].match);
  }
  return decided;
}

}  // namespace lowlap
