#pragma once

#include <array>
#include <vector>

#include "lowlap/robust/internal/nfa.h"
#include "lowlap/scale/internal/criterion/ratio_density.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/scale_options.h"

namespace lowlap {

/// A kind at its best threshold, in its best tier.
struct KindNfa : NfaTerm {
  int tier = 0;
};

/// The NFA of one tau, in total (the sum of the logs) and by kind of the
/// support.
struct RatioNfa {
  double log10_nfa = 0;
  /// The total without the caps: orders ratios that chance explains.
  double uncapped = 0;
  std::vector<KindNfa> kinds;

  bool BetterThan(const RatioNfa& other) const {
    return log10_nfa != other.log10_nfa ? log10_nfa < other.log10_nfa
                                        : uncapped < other.uncapped;
  }
};

/// A log ratio and its NFA.
struct RatioOptimum {
  double log_ratio = 0;
  RatioNfa nfa;
};

/// Lower bounds of log10 NFA over an interval of ratios.
struct RatioNfaBound {
  double log10_nfa = 0;
  /// The same if this step of the ladder decides for this tier; infinite where
  /// the step cannot say anything.
  std::vector<LadderValues> tiers;
};

/// The a-contrario criterion of a triplet (Salaün et al. 2017, section 6).
///
/// Calibrated form, where it differs from the paper's and why:
///  - The background probability that an unrelated candidate is an inlier at
///    threshold e is measured on the triplet's own candidates, unless a kind
///    knows it: their errors at ratios drawn (without chance, by ranks) from
///    the ratios of their kind, each displaced by a logistic with scale
///    RatioDensity::kSpread of log tau.
///    A feature that has been verified by two epipolar geometries can only
///    slide along its epipolar lines, and by no more than the depth of the
///    scene; a fixed law such as 2 D e / A overlooks that, most of all for
///    short baselines. Few draws say little about small e, so the law is
///    continued in proportion to e from above, and it is never below 2 D e / A.
///  - Where the hypotheses of a kind are dense, unrelated ones agree more
///    often: the law is scaled by the density of the kind's ratios at tau,
///    smoothed by the same logistic, over its mean.
///  - The least error of a member of pairs over its partners is measured as
///    such, so that the number of partners is paid for.
///  - A pair has two members: see CalibratedPairValues.
///  - Of the tiers of a kind the best counts, which is paid for by their
///    number.
///  - Only the kind of the sampled candidate loses one sample.
///  - Every probability, and the NFA of every kind, is at most 1: a kind with
///    nothing to say never outvotes the others.
///  - The number of tests is the number of ratios at which a candidate becomes
///    an inlier (Evidence::NumTests), times 2 for every kind that may speak or
///    be capped, times 2 as a margin for the background. It is the same for
///    every search, so that their results can be compared.
/// So built, at most one ratio in a hundred comes out below NFA 1 on triplets
/// of unrelated features (tests/scale).
/// Paper form: the product of the terms of the kinds (Evidence::PaperTerm).
///
/// Not for several threads at once.
class RatioNfaCriterion {
 public:
  /// Refers to the support.
  RatioNfaCriterion(const RatioSupport& support, const TripletView& triplet,
                    NfaForm form);

  /// The NFA of a hypothesis, from the inliers at its ratio.
  RatioNfa Evaluate(const Hypothesis& hypothesis,
                    const SupportCounts& counts) const;
  /// The NFA of any log ratio, in the calibrated form: the least over the kinds
  /// that the ratio may have been computed from. The inliers that decide share
  /// an interval of ratios, and one of its ends is where one of them becomes an
  /// inlier: trying all ends tries as many ratios as there are hypotheses.
  RatioOptimum EvaluateAt(double log_ratio, const SupportCounts& counts) const;
  /// Lower bounds over an interval of log ratios, from counts that no ratio in
  /// it exceeds.
  RatioNfaBound Bound(double low, double high, const SupportCounts& most) const;

 private:
  // What unrelated units of one tier do, by side.
  struct Background {
    std::array<LadderProbabilities, 2> log10_alpha{};
    RatioDensity density;
  };
  // A tier by itself at every step.
  struct TierValues {
    LadderValues unsampled{};
    LadderValues sampled{};
  };
  void MeasureBackground(int kind, const TripletView& triplet);
  RatioNfa EvaluatePaper(const SupportCounts& counts) const;
  // Fills values_; log10_density(tier).
  template <class Density>
  void FindValues(const SupportCounts& counts,
                  const Density& log10_density) const;
  // Of the tiers that have candidates; those from `sampled_tier` on are
  // sampled.
  KindNfa LeastOverTiers(int kind, int sampled_tier) const;
  RatioNfa LeastOverKinds() const;
  // A ratio from a candidate of a wider tier is not a sample of the nearer
  // ones.
  int LastTier(int kind) const;
  // The sum of the terms.
  RatioNfa Total(std::vector<KindNfa> terms) const;

  const RatioSupport& support_;
  NfaForm form_;
  double log10_tests_;
  LogFactorials factorials_;
  std::vector<Background> backgrounds_;  // by tier
  // Buffers.
  mutable std::vector<TierValues> values_;  // by tier
  mutable std::vector<KindNfa> sampled_;    // by kind
};

}  // namespace lowlap
