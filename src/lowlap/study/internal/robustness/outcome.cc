#include "lowlap/study/internal/robustness/outcome.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

struct Placement {
  double scale = 1;
  Vec3 translation = Vec3::Zero();
};

Placement WeightedFit(const std::vector<Vec3>& from,
                      const std::vector<Vec3>& to,
                      const std::vector<double>& weights) {
  Vec3 from_mean = Vec3::Zero(), to_mean = Vec3::Zero();
  double total = 0;
  for (std::size_t n = 0; n < from.size(); ++n) {
    from_mean += weights[n] * from[n];
    to_mean += weights[n] * to[n];
    total += weights[n];
  }
  from_mean /= total;
  to_mean /= total;
  double dot = 0, square = 0;
  for (std::size_t n = 0; n < from.size(); ++n) {
    dot += weights[n] * (from[n] - from_mean).dot(to[n] - to_mean);
    square += weights[n] * (from[n] - from_mean).squaredNorm();
  }
  Placement fit;
  fit.scale = square > 0 ? std::max(dot / square, 0.0) : 0.0;
  fit.translation = to_mean - fit.scale * from_mean;
  return fit;
}

std::vector<double> Distances(const std::vector<Vec3>& from,
                              const std::vector<Vec3>& to,
                              const Placement& fit) {
  std::vector<double> distances;
  distances.reserve(from.size());
  for (std::size_t n = 0; n < from.size(); ++n) {
    distances.push_back((to[n] - fit.scale * from[n] - fit.translation).norm());
  }
  return distances;
}

// Of the placements that two centres fix, the one of least median distance;
// then reweighted (Geman-McClure) least squares.
Placement RobustFit(const std::vector<Vec3>& from,
                    const std::vector<Vec3>& to) {
  constexpr int kDraws = 200, kPolish = 20;
  std::vector<double> weights(from.size(), 1.0);
  Placement best = WeightedFit(from, to, weights);
  double least = Median(Distances(from, to, best));
  Random random(0);
  const auto count = static_cast<std::uint32_t>(from.size());
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::uint32_t a = random.Index(count), b = random.Index(count);
    if (a == b) continue;
    const Placement fit =
        WeightedFit({from[a], from[b]}, {to[a], to[b]}, {1.0, 1.0});
    const double median = Median(Distances(from, to, fit));
    if (median < least) {
      least = median;
      best = fit;
    }
  }
  for (int step = 0; step < kPolish; ++step) {
    const std::vector<double> distances = Distances(from, to, best);
    const double scale = 3 * Median(distances);
    if (!(scale > 0)) break;
    for (std::size_t n = 0; n < from.size(); ++n) {
      weights[n] = 1 / std::pow(1 + std::pow(distances[n] / scale, 2), 2);
    }
    best = WeightedFit(from, to, weights);
  }
  return best;
}

double Spread(const std::vector<Vec3>& centers) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& center : centers) mean += center;
  mean /= static_cast<double>(centers.size());
  double squares = 0;
  for (const Vec3& center : centers) squares += (center - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(centers.size()));
}

}  // namespace

const char* RobustnessStatusName(RobustnessStatus status) {
  switch (status) {
    case RobustnessStatus::kSolved:
      return "solved";
    case RobustnessStatus::kFailed:
      return "failed";
    case RobustnessStatus::kOverTime:
      return "time";
    case RobustnessStatus::kNotAsked:
      return "not asked";
  }
  return "";
}

RobustnessOutcome JudgeCenters(const std::vector<Vec3>& truth, int num_views,
                               const TranslationSolution& solution,
                               const Mat3& truth_from_solved,
                               double tolerance) {
  RobustnessOutcome outcome;
  outcome.status = RobustnessStatus::kSolved;
  outcome.num_views = num_views;
  outcome.median_error = HUGE_VAL;
  std::vector<Vec3> from, to;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    if (solution.component[n] != 0) continue;
    from.emplace_back(truth_from_solved * solution.center_in_world[n]);
    to.push_back(truth[n]);
  }
  outcome.num_placed = static_cast<int>(from.size());
  if (from.size() < 2) return outcome;
  const double spread = Spread(truth);
  const Placement fit = RobustFit(from, to);
  std::vector<double> errors = Distances(from, to, fit);
  for (double& error : errors) error /= spread;
  errors.resize(static_cast<std::size_t>(num_views), HUGE_VAL);
  outcome.num_right = static_cast<int>(
      std::count_if(errors.begin(), errors.end(),
                    [&](double error) { return error <= tolerance; }));
  outcome.median_error = Median(std::move(errors));
  return outcome;
}

}  // namespace lowlap
