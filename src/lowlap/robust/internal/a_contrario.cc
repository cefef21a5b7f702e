#include "lowlap/robust/internal/a_contrario.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr int kStepShift = 21;  // 23 mantissa bits: four steps per octave

std::uint32_t FloatBits(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof(bits));
  return bits;
}

float FloatFromBits(std::uint32_t bits) {
  float x;
  std::memcpy(&x, &bits, sizeof(x));
  return x;
}

}  // namespace

double BackgroundLaw::Alpha(double residual) const {
  return std::min(1.0, coefficient * std::pow(residual, dimension));
}

AContrarioLadder::AContrarioLadder(int num_data, int sample_size,
                                   int max_models_per_sample,
                                   const BackgroundLaw& law,
                                   double min_threshold, double max_threshold)
    : num_data_(num_data), sample_size_(sample_size) {
  first_bits_ = FloatBits(static_cast<float>(min_threshold * min_threshold));
  const std::uint32_t last_bits =
      FloatBits(static_cast<float>(max_threshold * max_threshold));
  for (std::uint32_t bits = first_bits_; bits <= last_bits;
       bits += 1u << kStepShift) {
    const double threshold =
        std::sqrt(static_cast<double>(FloatFromBits(bits)));
    thresholds_.push_back(threshold);
    log10_alpha_.push_back(std::log10(law.Alpha(threshold)));
  }
  const double log10_tests = std::log10(static_cast<double>(NumSteps()) *
                                        std::max(1, max_models_per_sample));
  log10_tests_.assign(num_data + 1, std::numeric_limits<double>::infinity());
  for (int k = sample_size + 1; k <= num_data; ++k) {
    log10_tests_[k] = log10_tests + Log10Binomial(num_data, k) +
                      Log10Binomial(k, sample_size);
  }
}

AContrarioLadder AContrarioLadder::WithBackground(
    const std::vector<int>& background_counts) const {
  const double total =
      std::accumulate(background_counts.begin(), background_counts.end(), 1.0);
  AContrarioLadder ladder = *this;
  double below = 1;
  for (int step = 0; step < NumSteps(); ++step) {
    below += background_counts[step];
    ladder.log10_alpha_[step] =
        std::max(log10_alpha_[step], std::log10(below / total));
  }
  return ladder;
}

int AContrarioLadder::Step(float squared_residual) const {
  const std::uint32_t bits = FloatBits(squared_residual);
  if (bits <= first_bits_) return 0;
  const std::uint32_t step = ((bits - first_bits_ - 1) >> kStepShift) + 1;
  return static_cast<int>(
      std::min(step, static_cast<std::uint32_t>(NumSteps())));
}

double AContrarioLadder::Log10Nfa(int num_inliers, int step) const {
  if (num_inliers <= sample_size_) {
    return std::numeric_limits<double>::infinity();
  }
  return log10_tests_[num_inliers] +
         (num_inliers - sample_size_) * log10_alpha_[step];
}

AContrarioScore AContrarioLadder::Best(const std::vector<int>& counts) const {
  AContrarioScore best{std::numeric_limits<double>::infinity(), 0, 0};
  int num_inliers = 0;
  for (int step = 0; step < NumSteps(); ++step) {
    if (counts[step] == 0) continue;  // no better than the step before
    num_inliers += counts[step];
    const double log10_nfa = Log10Nfa(num_inliers, step);
    if (log10_nfa < best.log10_nfa) {
      best = {log10_nfa, thresholds_[step], num_inliers};
    }
  }
  return best;
}

AContrarioScore AContrarioLadder::Score(
    const std::vector<float>& squared_residuals) const {
  std::vector<int> counts(NumSteps() + 1, 0);
  for (const float squared : squared_residuals) ++counts[Step(squared)];
  return Best(counts);
}

int AContrarioLadder::InliersToBeat(double log10_nfa, int step) const {
  // Beyond its maximum over k the NFA falls; more inliers never hurt the
  // answer, so the search runs down from all data.
  int k = num_data_ + 1;
  while (k > sample_size_ + 1 && Log10Nfa(k - 1, step) < log10_nfa) --k;
  return k;
}

}  // namespace lowlap
