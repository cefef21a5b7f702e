#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/robust/internal/a_contrario.h"

namespace lowlap {

struct AContrarioRansacOptions {
  int min_samples = 100;
  int max_samples = 10000;
  /// Probability with which an all-inlier sample is drawn at least once.
  double confidence = 0.9999;
  /// Local optimisation steps at each new best model.
  int max_refinements = 5;
};

template <class Model>
struct AContrarioRansacResult {
  /// Absent if no sample gave a model with more inliers than the sample.
  std::optional<Model> model;
  AContrarioScore score{std::numeric_limits<double>::infinity(), 0, 0};
  int num_samples = 0;
};

/// Draws `count` different indices below `num_data`.
template <std::size_t kCount>
std::array<int, kCount> DrawSample(int num_data, Random& random) {
  std::array<int, kCount> sample;
  for (std::size_t i = 0; i < kCount;) {
    sample[i] = static_cast<int>(random.Index(num_data));
    std::size_t j = 0;
    while (sample[j] != sample[i]) ++j;
    if (j == i) ++i;
  }
  return sample;
}

/// Tells after a part of the data, in random order, whether a model may still
/// beat the best one: it may if at some threshold its inliers so far are no
/// more than 4 standard deviations below their due share of the number needed.
class EarlyBailOut {
 public:
  EarlyBailOut(const AContrarioLadder& ladder, int num_data)
      : ladder_(ladder), num_data_(num_data) {}

  void SetBest(double log10_nfa);
  /// counts[j]: residuals in step j among the first `num_seen` data.
  bool MayWin(const std::vector<int>& counts, int num_seen) const;

 private:
  const AContrarioLadder& ladder_;
  int num_data_;
  std::vector<double> share_needed_;  // by step; > 1: out of reach
};

/// RANSAC with the a-contrario criterion: no inlier threshold; the model of
/// least NFA wins (Moisan, Stival 2004), with local optimisation at every new
/// best (Chum, Matas, Kittler 2003).
///
/// A Kernel holds the data, in random order, and provides
///   using Model;  static constexpr int kSampleSize;
///   int NumData() const;
///   void Solve(const std::array<int, kSampleSize>&, std::vector<Model>&)
///   const; void SquaredResiduals(const Model&, int begin, int end, float* out)
///   const; std::optional<Model> Refine(const Model&, double threshold) const;
/// Refine fits to the inliers of the given model at the given threshold.
template <class Kernel>
AContrarioRansacResult<typename Kernel::Model> AContrarioRansac(
    const Kernel& kernel, const AContrarioLadder& ladder,
    const AContrarioRansacOptions& options, Random& random) {
  using Model = typename Kernel::Model;
  constexpr int kSampleSize = Kernel::kSampleSize;
  const int num_data = kernel.NumData();
  AContrarioRansacResult<Model> best;
  if (num_data <= kSampleSize) return best;

  std::vector<float> squared(num_data);
  std::vector<int> counts(ladder.NumSteps() + 1);
  EarlyBailOut bail_out(ladder, num_data);
  // The score of a model; nullopt as soon as it cannot win any more.
  const auto evaluate =
      [&](const Model& model) -> std::optional<AContrarioScore> {
    counts.assign(counts.size(), 0);
    for (int begin = 0, end = 32; begin < num_data; begin = end, end *= 4) {
      end = std::min(end, num_data);
      kernel.SquaredResiduals(model, begin, end, squared.data());
      for (int i = begin; i < end; ++i) ++counts[ladder.Step(squared[i])];
      if (end < num_data && !bail_out.MayWin(counts, end)) return std::nullopt;
    }
    return ladder.Best(counts);
  };
  const auto samples_needed = [&] {
    double all_inliers = 1;
    for (int i = 0; i < kSampleSize; ++i) {
      all_inliers *= static_cast<double>(best.score.num_inliers - i) /
                     static_cast<double>(num_data - i);
    }
    return std::log(1 - options.confidence) /
           std::log1p(-std::min(all_inliers, 1 - 1e-12));
  };

  std::vector<Model> models;
  double needed = options.max_samples;
  while (
      best.num_samples < options.max_samples &&
      (best.num_samples < options.min_samples || best.num_samples < needed)) {
    ++best.num_samples;
    models.clear();
    kernel.Solve(DrawSample<kSampleSize>(num_data, random), models);
    for (const Model& model : models) {
      std::optional<AContrarioScore> score = evaluate(model);
      if (!score || !(score->log10_nfa < best.score.log10_nfa)) continue;
      best.model = model;
      best.score = *score;
      bail_out.SetBest(best.score.log10_nfa);
      for (int step = 0; step < options.max_refinements; ++step) {
        const std::optional<Model> refined =
            kernel.Refine(*best.model, best.score.threshold);
        if (!refined) break;
        score = evaluate(*refined);
        if (!score || !(score->log10_nfa < best.score.log10_nfa)) break;
        best.model = *refined;
        best.score = *score;
        bail_out.SetBest(best.score.log10_nfa);
      }
      needed = samples_needed();
    }
  }
  return best;
}

}  // namespace lowlap
