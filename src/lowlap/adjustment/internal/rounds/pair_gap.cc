#include "lowlap/adjustment/internal/rounds/pair_gap.h"

#include <cmath>
#include <map>
#include <optional>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {

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
  NoiseScale noise =
      EstimateNoise(gaps_px,
                    BackgroundLaw::PointToLine(cameras.MeanImageArea(),
                                               cameras.MeanImageDiagonal()),
                    kMedianOfNorm<1>, pair_bounds);
  noise.stddev_px = std::max(noise.stddev_px, line_noise.stddev_px);
  noise.threshold_px = std::max(noise.threshold_px, line_noise.threshold_px);
  return noise;
}

}  // namespace lowlap
