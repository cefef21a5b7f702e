#pragma once

#include <array>
#include <vector>

#include "lowlap/robust/internal/nfa.h"
#include "lowlap/scale/internal/criterion/ratio_density.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/scale_options.h"

namespace lowlap {

/// What a kind says, at one threshold in one tier.
struct KindNfa : NfaTerm {
  int tier = 0;
  /// Its inliers there are part of the total, as witnesses or as the sample.
  bool speaks = false;
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
///  - A pair has two members: see CalibratedPairValues. The side that says less
///    counts; the step of its kind (KindNfa::step) is that at which both say
///    most, since inliers reach as far as they do for both.
///  - Of the tiers of a kind the best counts, which is paid for by their
///    number.
///  - One sample is taken from all kinds together: see Evaluate.
///  - Every probability, and the NFA of every kind, is at most 1: a kind with
///    nothing to say never outvotes the others.
///  - The number of tests is the number of ratios at which a candidate becomes
///    an inlier (Evidence::NumTests), times what the product of as many kinds
///    gains by chance: 4, 8, 26 and 67 for one to four of them, with a margin
///    for the background. It is the same for every search, so that their
///    results can be compared.
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

  /// The NFA of a log ratio, from the inliers there.
  ///
  /// In the calibrated form every kind speaks at one threshold in one tier, or
  /// not at all. The inliers that speak share an interval of ratios, and it
  /// begins where the last of them becomes one. That candidate is the sample
  /// from which the ratio was computed, and no witness: trying all such ends
  /// tries as many ratios as there are hypotheses. Whose it is cannot be told
  /// from counts, so the kind counts as sampled that loses most by it. A kind
  /// with one unit thus never says anything for itself, and one without inliers
  /// is not the sample of others. Of all choices of thresholds and tiers the
  /// least NFA counts.
  RatioNfa Evaluate(double log_ratio, const SupportCounts& counts) const;
  /// Lower bounds over an interval of log ratios, from counts that no ratio in
  /// it exceeds.
  RatioNfaBound Bound(double low, double high, const SupportCounts& most) const;

 private:
  // What unrelated units of one tier do, by side.
  struct Background {
    std::array<LadderProbabilities, 2> log10_alpha{};
    RatioDensity density;
  };
  // A tier by itself at every step: its log10 NFA, and what orders the steps
  // where that says nothing.
  struct TierValues {
    PairLadderValues unsampled;
    PairLadderValues sampled;
  };
  void MeasureBackground(int kind, const TripletView& triplet);
  RatioNfa EvaluatePaper(const SupportCounts& counts) const;
  // Fills values_; log10_density(tier).
  template <class Density>
  void FindValues(const SupportCounts& counts,
                  const Density& log10_density) const;
  // What a kind may say, as a witness alone and with the sample; nothing (0) if
  // it is silent.
  struct Choice {
    double unsampled = 0;
    double sampled = 0;
    int tier = 0;
    int step = 0;

    double Loss() const { return sampled - unsampled; }
  };
  // The one that says most and loses less than `limit`.
  Choice LeastChoice(int kind, double limit) const;
  // A kind by itself at its best, silent.
  KindNfa LeastUncapped(int kind, PairLadderValues TierValues::*values) const;
  // All of them, the sample that is missed most taken away.
  RatioNfa LeastUncapped() const;
  RatioNfa LeastOverChoices() const;

  const RatioSupport& support_;
  NfaForm form_;
  double log10_tests_;
  LogFactorials factorials_;
  std::vector<Background> backgrounds_;  // by tier
  // Buffers.
  mutable std::vector<TierValues> values_;  // by tier
  mutable std::vector<Choice> choices_;     // by kind
};

}  // namespace lowlap
