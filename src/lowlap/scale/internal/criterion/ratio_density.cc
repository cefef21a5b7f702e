#include "lowlap/scale/internal/criterion/ratio_density.h"

#include <algorithm>
#include <cmath>

namespace lowlap {
namespace {

constexpr double kGridStep = RatioDensity::kSpread / 4;
constexpr int kKernelRadius = 32;  // the logistic at 8 scales: 3e-4
// Ratios beyond e^8 of each other are counted at the end of the grid.
constexpr double kMaxRange = 16.0;
constexpr double kMinRelative = 0.5;

// By distance in steps of the grid.
std::vector<double> Kernel() {
  std::vector<double> kernel;
  for (int offset = 0; offset <= kKernelRadius; ++offset) {
    const double half = 0.5 * offset * kGridStep / RatioDensity::kSpread;
    kernel.push_back(1.0 / (std::cosh(half) * std::cosh(half)));
  }
  return kernel;
}

}  // namespace

RatioDensity::RatioDensity(const std::vector<double>& sorted) {
  if (sorted.empty()) return;
  const double median =
      0.5 * (sorted[sorted.size() / 2] + sorted[(sorted.size() - 1) / 2]);
  const double first = std::max(sorted.front(), median - kMaxRange / 2);
  const double last = std::min(sorted.back(), median + kMaxRange / 2);
  const int num_nodes =
      static_cast<int>(std::ceil((last - first) / kGridStep)) +
      2 * kKernelRadius + 2;
  // Around the middle, for the same grid whichever end is the first.
  low_ = 0.5 * (first + last) - 0.5 * (num_nodes - 1) * kGridStep;

  // Every ratio is shared by the two nodes beside it.
  std::vector<double> mass(num_nodes, 0.0);
  for (const double log_ratio : sorted) {
    const double at = (std::clamp(log_ratio, first, last) - low_) / kGridStep;
    const int node = static_cast<int>(at);
    mass[node] += node + 1 - at;
    mass[node + 1] += at - node;
  }
  static const std::vector<double> kernel = Kernel();
  std::vector<double> density(num_nodes, 0.0);
  for (int node = 0; node < num_nodes; ++node) {
    if (mass[node] == 0) continue;
    const int begin = std::max(0, node - kKernelRadius);
    const int end = std::min(num_nodes, node + kKernelRadius + 1);
    for (int at = begin; at < end; ++at) {
      density[at] += mass[node] * kernel[std::abs(at - node)];
    }
  }
  double sum = 0, sum_of_squares = 0;
  for (const double value : density) {
    sum += value;
    sum_of_squares += value * value;
  }
  const double mean = sum_of_squares / sum;
  for (const double value : density) {
    log10_relative_.push_back(std::log10(std::max(kMinRelative, value / mean)));
  }
}

double RatioDensity::Log10Relative(double log_ratio) const {
  if (log10_relative_.empty()) return 0.0;
  const int last = static_cast<int>(log10_relative_.size()) - 1;
  const double at = std::clamp((log_ratio - low_) / kGridStep, 0.0,
                               static_cast<double>(last));
  const int node = std::min(static_cast<int>(at), last - 1);
  const double share = at - node;
  return (1 - share) * log10_relative_[node] +
         share * log10_relative_[node + 1];
}

double RatioDensity::LeastLog10Relative(double low, double high) const {
  double least = std::min(Log10Relative(low), Log10Relative(high));
  const int num_nodes = static_cast<int>(log10_relative_.size());
  if (num_nodes == 0) return least;
  const auto node_at = [&](double log_ratio) {
    return static_cast<int>(
        std::clamp((log_ratio - low_) / kGridStep, 0.0, num_nodes - 1.0));
  };
  for (int node = node_at(low) + 1; node <= node_at(high); ++node) {
    least = std::min(least, log10_relative_[node]);
  }
  return least;
}

}  // namespace lowlap
