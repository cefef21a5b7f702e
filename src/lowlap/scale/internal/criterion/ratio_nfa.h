#pragma once

#include <array>

#include "lowlap/robust/nfa.h"
#include "lowlap/scale/internal/criterion/ratio_density.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/scale_options.h"

namespace lowlap {

/// The NFA of one tau, by kind and in total (the sum of the logs).
struct RatioNfa {
  double log10_nfa = 0;
  /// The total without the caps: orders ratios that chance explains.
  double uncapped = 0;
  NfaTerm points;
  NfaTerm lines;
  NfaTerm coplanar;
  NfaTerm plane_points;
  int coplanar_tier = 0;  // the tier of pairs that `coplanar` counts

  bool BetterThan(const RatioNfa& other) const {
    return log10_nfa != other.log10_nfa ? log10_nfa < other.log10_nfa
                                        : uncapped < other.uncapped;
  }
};

/// Lower bounds of log10 NFA over an interval of ratios.
struct RatioNfaBound {
  double log10_nfa = 0;
  /// The same if this step of the ladder decides for this kind (or tier of
  /// pairs); infinite where the step cannot say anything.
  LadderValues points;
  LadderValues lines;
  LadderValues plane_points;
  std::array<LadderValues, kPairTiers> coplanar;
};

/// The a-contrario criterion of a triplet (Salaün et al. 2017, section 6).
///
/// Calibrated form, where it differs from the paper's and why:
///  - The background probability that an unrelated feature is an inlier at
///    threshold e is measured on the triplet's own features: their errors at
///    ratios drawn (without chance, by ranks) from the ratios of their kind,
///    each displaced by a logistic with scale RatioDensity::kSpread of log tau.
///    A feature that has been verified by two epipolar geometries can only
///    slide along its epipolar lines, and by no more than the depth of the
///    scene; a fixed law such as 2 D e / A overlooks that, most of all for
///    short baselines. Few draws say little about small e, so the law is
///    continued in proportion to e from above, and it is never below 2 D e / A.
///  - Where the hypotheses of a kind are dense, unrelated ones agree more
///    often: the law is scaled by the density of the kind's ratios at tau,
///    smoothed by the same logistic, over its mean.
///  - The least error of a line over its partners is measured as such, so that
///    the number of partners is paid for.
///  - A pair has two lines: see CalibratedPairValues.
///  - Of the tiers of pairs (support_counts.h) the best counts, which is paid
///    for by their number.
///  - Only the kind of the sampled feature loses one sample.
///  - Every probability, and the NFA of every kind, is at most 1: a kind with
///    nothing to say never outvotes the others.
///  - The number of tests is the number of ratios at which a feature becomes
///    an inlier (see ratio_sweep.h), times 2 for every kind that may speak or
///    be capped, times 2 as a margin for the background. It is the same for
///    every search, so that their results can be compared.
/// So built, at most one ratio in a hundred comes out below NFA 1 on triplets
/// of unrelated features (tests/scale).
/// Paper form: the product of the three printed terms.
class RatioNfaCriterion {
 public:
  RatioNfaCriterion(const RatioSupport& support, const TripletView& triplet,
                    const ScaleOptions& options);

  /// The NFA of a hypothesis, from the inliers at its ratio.
  RatioNfa Evaluate(const Hypothesis& hypothesis,
                    const SupportCounts& counts) const;
  /// The NFA of any log ratio, in the calibrated form: the least over the kinds
  /// that the ratio may have been computed from. The inliers that decide share
  /// an interval of ratios, and one of its ends is where one of them becomes an
  /// inlier: trying all ends tries as many ratios as there are hypotheses.
  RatioNfa EvaluateAt(double log_ratio, const SupportCounts& counts) const;
  /// Lower bounds over an interval of log ratios, from counts that no ratio in
  /// it exceeds.
  RatioNfaBound Bound(double low, double high, const SupportCounts& most) const;

 private:
  // What unrelated features of one kind do.
  struct Background {
    LadderProbabilities log10_alpha{};
    RatioDensity density;
  };
  struct PairBackground {
    LadderProbabilities log10_alpha_first{};
    LadderProbabilities log10_alpha_last{};
    RatioDensity density;
  };
  void MeasureBackground(const TripletView& triplet);
  void EvaluatePaper(const SupportCounts& counts, RatioNfa* nfa) const;
  // log10 of the densities by kind: points, lines, plane points, tiers of
  // pairs.
  using Densities = std::array<double, 3 + kPairTiers>;
  Densities DensitiesAt(double log_ratio) const;
  // A kind (tier) by itself at every step, unsampled and sampled.
  struct KindValues {
    LadderValues unsampled{};
    LadderValues sampled{};
  };
  struct AllValues {
    KindValues points;
    KindValues lines;
    KindValues plane_points;
    std::array<KindValues, kPairTiers> coplanar;
  };
  AllValues Values(const SupportCounts& counts,
                   const Densities& densities) const;
  // Of the tiers that have pairs; those from `sampled_tier` on are sampled.
  NfaTerm LeastOverTiers(const std::array<KindValues, kPairTiers>& values,
                         int sampled_tier, int* best_tier) const;
  void EvaluateCalibrated(const Hypothesis& hypothesis,
                          const SupportCounts& counts, RatioNfa* nfa) const;
  RatioNfa LeastOverKinds(const AllValues& values) const;

  const RatioSupport& support_;
  NfaForm form_;
  int num_neighbors_;
  double image_area_px2_;
  double image_diagonal_px_;
  double log10_tests_;
  LogFactorials factorials_;
  Background points_;
  Background lines_;
  Background plane_points_;
  std::array<PairBackground, kPairTiers> pairs_;
};

}  // namespace lowlap
