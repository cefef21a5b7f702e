#include "lowlap/scale/ratio_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "lowlap/core/median.h"

namespace lowlap {
namespace {

// Cauchy's constant for 95 % efficiency on normal residuals.
constexpr double kCauchy = 2.3849;

// Squared noise of every group in units of the inliers' own deviations.
std::vector<double> GroupNoise(const std::vector<RatioInlier>& inliers,
                               double log_ratio) {
  constexpr double kStddevOfMedianDeviation = 1.4826;
  constexpr double kPriorCount = 2.0;
  std::vector<std::vector<double>> deviations;
  for (const RatioInlier& inlier : inliers) {
    const std::size_t group = static_cast<std::size_t>(inlier.group);
    if (deviations.size() <= group) deviations.resize(group + 1);
    deviations[group].push_back(std::abs(inlier.log_ratio - log_ratio) /
                                inlier.log_ratio_stddev);
  }
  std::vector<double> noise;
  for (std::vector<double>& group : deviations) {
    const double count = static_cast<double>(group.size());
    const double spread = kStddevOfMedianDeviation * Median(std::move(group));
    noise.push_back((count * (spread * spread) + kPriorCount) /
                    (count + kPriorCount));
  }
  return noise;
}

double Weight(const RatioInlier& inlier, const std::vector<double>& noise,
              double log_ratio) {
  const double residual = inlier.log_ratio - log_ratio;
  const double variance =
      noise[inlier.group] * inlier.log_ratio_stddev * inlier.log_ratio_stddev;
  const double robust =
      1.0 / (1.0 + residual * residual / (kCauchy * kCauchy * variance));
  return robust / (variance * inlier.multiplicity);
}

// Derivative of an inlier's term in the estimating equation sum w r = 0.
double Curvature(const RatioInlier& inlier, const std::vector<double>& noise,
                 double log_ratio) {
  const double residual = inlier.log_ratio - log_ratio;
  const double variance =
      noise[inlier.group] * inlier.log_ratio_stddev * inlier.log_ratio_stddev;
  const double squared = residual * residual / (kCauchy * kCauchy * variance);
  return (1.0 - squared) /
         ((1.0 + squared) * (1.0 + squared) * variance * inlier.multiplicity);
}

// Of the weighted mean, from the sums over cells; 0 with too few of them.
double CellVariance(const std::vector<RatioInlier>& inliers,
                    const std::vector<double>& noise, double log_ratio,
                    double information) {
  constexpr std::size_t kMinCells = 4;
  std::map<int, double> sums;
  for (const RatioInlier& inlier : inliers) {
    sums[inlier.cell] +=
        Weight(inlier, noise, log_ratio) * (inlier.log_ratio - log_ratio);
  }
  if (sums.size() < kMinCells) return 0;
  double sum_of_squares = 0;
  for (const auto& [cell, sum] : sums) sum_of_squares += sum * sum;
  const double num_cells = static_cast<double>(sums.size());
  return num_cells / (num_cells - 1) * sum_of_squares /
         (information * information);
}

}  // namespace

RefinedRatio RefineRatio(const std::vector<RatioInlier>& inliers,
                         double initial) {
  constexpr int kMaxIterations = 20;
  // In standard deviations of the result.
  constexpr double kAccuracy = 1e-5;
  constexpr double kSettled = 0.02;
  if (inliers.empty()) {
    return {initial, std::numeric_limits<double>::infinity(), {}};
  }
  double log_ratio = initial;
  double information = 0;
  bool is_settled = false;  // so that the noise changes no more
  std::vector<double> noise;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!is_settled) noise = GroupNoise(inliers, log_ratio);
    double sum = 0;
    information = 0;
    for (const RatioInlier& inlier : inliers) {
      const double weight = Weight(inlier, noise, log_ratio);
      sum += weight * (inlier.log_ratio - log_ratio);
      information += weight;
    }
    const double step = sum / information;
    log_ratio += step;
    const double stddevs = std::abs(step) * std::sqrt(information);
    if (stddevs < kAccuracy) break;
    is_settled = iteration > 0 && stddevs < kSettled;
  }
  double curvature = 0;
  for (const RatioInlier& inlier : inliers) {
    curvature += Curvature(inlier, noise, log_ratio);
  }
  curvature = std::max(curvature, 0.25 * information);
  const double variance = std::max(
      1.0 / information, CellVariance(inliers, noise, log_ratio, curvature));
  for (double& group : noise) group = std::sqrt(group);
  return {log_ratio, std::sqrt(variance), noise};
}

}  // namespace lowlap
