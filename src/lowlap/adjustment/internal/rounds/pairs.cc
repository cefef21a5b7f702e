#include "lowlap/adjustment/internal/rounds/pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "lowlap/adjustment/internal/costs/coplanar_costs.h"
#include "lowlap/adjustment/internal/costs/line_reprojection_cost.h"
#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {
namespace {

LineParameters Parameters(const LineTrackState& line) {
  LineParameters parameters;
  parameters << line.point, line.direction;
  return parameters;
}

constexpr int kMaxTimesDropped = 2;  // in and out for ever helps nobody

}  // namespace

std::vector<PairTerm> PairTerms(const StructureState& state,
                                const PairState& pair,
                                AdjustedCoplanarResidual residual) {
  const std::vector<int> first = ViewsOf(state.lines[pair.first]);
  const std::vector<int> second = ViewsOf(state.lines[pair.second]);
  std::vector<PairTerm> terms;
  if (residual == AdjustedCoplanarResidual::kImageDistance) {
    for (const int view : first) {
      if (std::binary_search(second.begin(), second.end(), view)) {
        terms.push_back({view, pair.first, pair.second});
      }
    }
    return terms;
  }
  for (const int view : second) {
    terms.push_back({view, pair.first, pair.second});
  }
  for (const int view : first) {
    terms.push_back({view, pair.second, pair.first});
  }
  return terms;
}

std::unique_ptr<ceres::CostFunction> MakePairCost(
    const CameraSet& cameras, const PairTerm& term,
    AdjustedCoplanarResidual residual) {
  const double focal_px = cameras.IntrinsicOf(term.view).value.MeanFocalPx();
  if (residual == AdjustedCoplanarResidual::kTransfer) {
    return std::make_unique<CoplanarTransferCost>(focal_px);
  }
  return std::make_unique<CoplanarImageDistanceCost>(focal_px);
}

double PairErrorPx(const CameraSet& cameras, const StructureState& state,
                   const PairState& pair, AdjustedCoplanarResidual residual) {
  const std::vector<PairTerm> terms = PairTerms(state, pair, residual);
  if (terms.empty()) return kInfinity;
  double squares = 0;
  for (const PairTerm& term : terms) {
    const LineParameters on = Parameters(state.lines[term.on]);
    const LineParameters to = Parameters(state.lines[term.to]);
    const Vec3& center = cameras.PoseOf(term.view).center;
    const double* const blocks[] = {center.data(), on.data(), to.data()};
    double values[3] = {0, 0, 0};
    MakePairCost(cameras, term, residual)->Evaluate(blocks, values, nullptr);
    squares +=
        values[0] * values[0] + values[1] * values[1] + values[2] * values[2];
  }
  const double error = std::sqrt(squares / static_cast<double>(terms.size()));
  return std::isfinite(error) ? error : kInfinity;
}

PairGap ComputePairGap(const LineEstimate& a, const LineEstimate& b) {
  const Vec3 cross = a.direction.cross(b.direction);
  const double sine = cross.norm();
  if (!(sine > 1e-9)) return {};
  const Vec3 normal = cross / sine;
  const Vec3 between = b.point - a.point;
  const auto variance = [&](const LineEstimate& line, double along) {
    Vec4 gradient;
    gradient.head<2>() = TangentBasis(line.direction).transpose() * normal;
    gradient.tail<2>() = along * gradient.head<2>();
    return gradient.dot(line.unit_covariance * gradient);
  };
  const double along_a = between.cross(b.direction).dot(normal) / sine;
  const double along_b = between.cross(a.direction).dot(normal) / sine;
  const double stddev = std::sqrt(variance(a, along_a) + variance(b, along_b));
  const PairGap gap{std::abs(between.dot(normal)) / stddev, stddev};
  return std::isfinite(gap.gap_px) && std::isfinite(stddev) ? gap : PairGap{};
}

std::vector<PairGap> ComputePairGaps(const CameraSet& cameras,
                                     const StructureState& state) {
  std::map<int, std::optional<LineEstimate>> estimates;
  for (const PairState& pair : state.pairs) {
    for (const int n : {pair.first, pair.second}) {
      if (state.lines[n].IsLandmark() && estimates.count(n) == 0) {
        estimates[n] = EstimateFromSegments(cameras, state.lines[n]);
      }
    }
  }
  std::vector<PairGap> gaps;
  gaps.reserve(state.pairs.size());
  for (const PairState& pair : state.pairs) {
    const auto a = estimates.find(pair.first), b = estimates.find(pair.second);
    const bool known =
        a != estimates.end() && b != estimates.end() && a->second && b->second;
    gaps.push_back(known ? ComputePairGap(*a->second, *b->second) : PairGap{});
  }
  return gaps;
}

NoiseScale EstimatePairNoise(const CameraSet& cameras,
                             const std::vector<PairGap>& gaps,
                             const NoiseScale& line_noise,
                             const NoiseBounds& bounds) {
  std::vector<double> gaps_px;
  gaps_px.reserve(gaps.size());
  for (const PairGap& gap : gaps) gaps_px.push_back(gap.gap_px);
  NoiseBounds pair_bounds = bounds;
  pair_bounds.fallback = line_noise;
  NoiseScale noise = EstimateNoise(gaps_px, cameras.PointToLine(),
                                   kMedianOfNorm<1>, pair_bounds);
  noise.stddev_px = std::max(noise.stddev_px, line_noise.stddev_px);
  noise.threshold_px = std::max(noise.threshold_px, line_noise.threshold_px);
  return noise;
}

std::size_t SelectPairs(const AdjustmentOptions& options,
                        const CameraSet& cameras, double threshold_px,
                        bool take_new, StructureState* state) {
  const std::vector<PairGap> gaps = ComputePairGaps(cameras, *state);
  std::vector<char> determined(state->lines.size(), 0);
  for (std::size_t n = 0; n < determined.size(); ++n) {
    determined[n] = state->lines[n].PoseCount(cameras) > 2 ? 1 : 0;
  }
  std::vector<int> degree(state->lines.size(), 0);
  std::vector<std::size_t> waiting;
  std::size_t changed = 0;
  for (std::size_t n = 0; n < gaps.size(); ++n) {
    PairState& pair = state->pairs[n];
    if (pair.used) {
      pair.used = std::isfinite(gaps[n].gap_px) &&
                  PairErrorPx(cameras, *state, pair,
                              options.coplanar_residual) <= threshold_px;
      pair.consistent = pair.used;
      if (pair.used) {
        ++degree[pair.first];
        ++degree[pair.second];
      } else {
        ++changed;
        ++pair.times_dropped;
      }
      continue;
    }
    pair.consistent =
        pair.times_dropped < kMaxTimesDropped && gaps[n].gap_px <= threshold_px;
    if (take_new && pair.consistent &&
        !(determined[pair.first] && determined[pair.second])) {
      waiting.push_back(n);
    }
  }
  std::stable_sort(waiting.begin(), waiting.end(),
                   [&](std::size_t a, std::size_t b) {
                     return gaps[a].unit_stddev < gaps[b].unit_stddev;
                   });
  for (const std::size_t n : waiting) {
    PairState& pair = state->pairs[n];
    if (degree[pair.first] >= options.max_pairs_per_line ||
        degree[pair.second] >= options.max_pairs_per_line) {
      continue;
    }
    ++degree[pair.first];
    ++degree[pair.second];
    pair.used = true;
    ++changed;
  }
  return changed;
}

}  // namespace lowlap
