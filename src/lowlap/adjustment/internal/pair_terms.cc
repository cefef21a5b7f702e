#include "lowlap/adjustment/internal/pair_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "lowlap/adjustment/internal/coplanar_costs.h"
#include "lowlap/adjustment/internal/line_reprojection_cost.h"
#include "lowlap/adjustment/internal/problem_selection.h"
#include "lowlap/geometry/rotation.h"

namespace lowlap::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LineParameters Parameters(const LineTrackState& line) {
  LineParameters parameters;
  parameters << line.point, line.direction;
  return parameters;
}

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

double PairErrorPx(const CameraSet& cameras, const StructureState& state,
                   const PairState& pair, AdjustedCoplanarResidual residual) {
  const std::vector<PairTerm> terms = PairTerms(state, pair, residual);
  if (terms.empty()) return kInfinity;
  double squares = 0;
  for (const PairTerm& term : terms) {
    const LineParameters on = Parameters(state.lines[term.on]);
    const LineParameters to = Parameters(state.lines[term.to]);
    const double focal_px = cameras.IntrinsicOf(term.view).value.MeanFocalPx();
    const Vec3& center = cameras.PoseOf(term.view).center;
    double values[3] = {0, 0, 0};
    if (residual == AdjustedCoplanarResidual::kTransfer) {
      CoplanarTransferCost{focal_px}(center.data(), on.data(), to.data(),
                                     values);
    } else {
      CoplanarImageDistanceCost{focal_px}(center.data(), on.data(), to.data(),
                                          values);
    }
    squares +=
        values[0] * values[0] + values[1] * values[1] + values[2] * values[2];
  }
  const double error = std::sqrt(squares / static_cast<double>(terms.size()));
  return std::isfinite(error) ? error : kInfinity;
}

double PairGapPx(const LineEstimate& a, const LineEstimate& b) {
  const Vec3 cross = a.direction.cross(b.direction);
  const double sine = cross.norm();
  if (!(sine > 1e-9)) return kInfinity;
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
  const double gap = std::abs(between.dot(normal)) /
                     std::sqrt(variance(a, along_a) + variance(b, along_b));
  return std::isfinite(gap) ? gap : kInfinity;
}

std::vector<double> PairGapsPx(const CameraSet& cameras,
                               const StructureState& state) {
  std::map<int, std::optional<LineEstimate>> estimates;
  for (const PairState& pair : state.pairs) {
    for (const int n : {pair.first, pair.second}) {
      if (state.lines[n].IsLandmark() && estimates.count(n) == 0) {
        estimates[n] = EstimateFromSegments(cameras, state.lines[n]);
      }
    }
  }
  std::vector<double> gaps_px;
  gaps_px.reserve(state.pairs.size());
  for (const PairState& pair : state.pairs) {
    const auto a = estimates.find(pair.first), b = estimates.find(pair.second);
    const bool known =
        a != estimates.end() && b != estimates.end() && a->second && b->second;
    gaps_px.push_back(known ? PairGapPx(*a->second, *b->second) : kInfinity);
  }
  return gaps_px;
}

NoiseScale EstimatePairNoise(const CameraSet& cameras,
                             const std::vector<double>& gaps_px,
                             const NoiseScale& line_noise,
                             const NoiseBounds& bounds) {
  NoiseBounds pair_bounds = bounds;
  pair_bounds.fallback = line_noise;
  NoiseScale noise =
      EstimateNoise(gaps_px,
                    BackgroundLaw::PointToLine(cameras.MeanImageArea(),
                                               cameras.MeanImageDiagonal()),
                    kUnitMedian1, pair_bounds);
  noise.stddev_px = std::max(noise.stddev_px, line_noise.stddev_px);
  noise.threshold_px = std::max(noise.threshold_px, line_noise.threshold_px);
  return noise;
}

}  // namespace lowlap::internal
