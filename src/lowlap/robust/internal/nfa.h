#pragma once

#include <vector>

#include "lowlap/robust/threshold_ladder.h"

namespace lowlap {

/// log10 of n! for n = 0 ... max_n, tabulated once; binomials are then three
/// look-ups.
class LogFactorials {
 public:
  explicit LogFactorials(int max_n);
  /// log10 C(n, k) for 0 <= k <= n <= max_n.
  double Log10Binomial(int n, int k) const {
    return table_[n] - table_[k] - table_[n - k];
  }

 private:
  std::vector<double> table_;
};

/// One kind of feature at its best threshold.
struct NfaTerm {
  double log10_nfa = 0;  // capped at 0 in the calibrated form
  /// Before the cap: orders hypotheses that are all explained by chance.
  double uncapped = 0;
  int step = 0;  // of the threshold ladder
};

/// The probability that the least of `num_partners` independent errors is an
/// inlier: 1 - (1 - alpha)^num_partners.
double BestOfPartners(double alpha, double num_partners);

/// log10 of C(n, k) alpha^k with alpha capped at 1.
///
/// It bounds the expected number of k-sets of unrelated features that are
/// inliers by chance together. With different probabilities alpha_i it holds
/// for their mean, since the elementary symmetric polynomial is at most
/// C(n, k) mean^k (Maclaurin).
double Log10ChanceOfSet(const LogFactorials& factorials, int n, int k,
                        double log10_alpha);

/// Per step, a log10 NFA.
using LadderValues = std::array<double, kNumThresholds>;
/// The least value and its step, uncapped and capped at 0.
NfaTerm LeastOverSteps(const LadderValues& values);

/// The calibrated NFA of one kind at every step; LeastOverSteps gives the term:
///   NFA = min(1, min over steps T C(n - s, k - s) alpha_step^(k - s)),
/// T = kNumThresholds tests, k the count at the step, s = `sampled` = 1 if the
/// hypothesis was computed from a feature of this kind (which is an inlier by
/// construction), else 0. `log10_alpha` is the background probability per step.
LadderValues CalibratedValues(const LogFactorials& factorials, int n,
                              const LadderCounts& counts,
                              const LadderProbabilities& log10_alpha,
                              int sampled);

/// Two sides at every step.
struct PairLadderValues {
  LadderValues log10_nfa{};
  /// The mean of the two sides: no NFA, but where there is none to tell ratios
  /// apart it prefers those on which more agree.
  LadderValues order{};
};

/// The same of pairs, whose members a (n_a of them) and b form two sides: an
/// inlier pair makes one member of each side an inlier, so that members of both
/// sides together would count every accident twice. Nor does the side that says
/// more count accidents: a bundle of lines of one plane agrees with a single
/// line of the other side, wherever that is. By chance no more agree than pairs
/// without a common member, hence the side that says less counts:
///   NFA = min(1, min over steps max(NFA_a, NFA_b)).
PairLadderValues CalibratedPairValues(const LogFactorials& factorials, int n_a,
                                      const LadderCounts& counts_a,
                                      const LadderProbabilities& log10_alpha_a,
                                      int n_b, const LadderCounts& counts_b,
                                      const LadderProbabilities& log10_alpha_b,
                                      int sampled);

/// The terms as printed in Salaün et al. 2017, section 6, with the thresholds
/// of the ladder for the errors e_k. They are **not** calibrated: on unrelated
/// features the coplanar term falls far below 1.
///   points    (n-1) min_k C(n,k) k [pi e_k^2 / A]^(k-1),       k in [2, n]
///   lines     (n-1) min_k C(n,k) k [2 D e_k / A]^(k-1),        k in [2, n]
///   coplanar  (n-2) min_k n N C(n,k-2) [pi e_k^2 / A]^(k-2),   k in [3, n]
/// n of the coplanar term counts lines; N is the number of neighbours. With
/// fewer features than the least k the term is 1.
NfaTerm PaperPointTerm(const LogFactorials& factorials, int n,
                       const LadderCounts& counts, double image_area_px2);
NfaTerm PaperLineTerm(const LogFactorials& factorials, int n,
                      const LadderCounts& counts, double image_area_px2,
                      double image_diagonal_px);
NfaTerm PaperCoplanarTerm(const LogFactorials& factorials, int n,
                          const LadderCounts& counts, double image_area_px2,
                          int num_neighbors);

}  // namespace lowlap
