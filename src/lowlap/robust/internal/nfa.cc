#include "lowlap/robust/internal/nfa.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lowlap {
namespace {

constexpr double kPi = 3.14159265358979323846;

// min over the steps of value(step), before and after the cap at log10 1.
template <class Value>
NfaTerm MinimumOverSteps(const Value& value, bool capped) {
  NfaTerm term;
  term.uncapped = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kNumThresholds; ++step) {
    const double log10_nfa = value(step);
    if (log10_nfa < term.uncapped) {
      term.uncapped = log10_nfa;
      term.step = step;
    }
  }
  term.log10_nfa = capped ? std::min(0.0, term.uncapped) : term.uncapped;
  return term;
}

// The paper needs at least min_k inliers; if no step has them, the widest one
// is taken with min_k.
template <class Value>
NfaTerm PaperMinimum(int n, int min_k, const LadderCounts& counts,
                     const Value& value) {
  if (n < min_k) return {};
  return MinimumOverSteps(
      [&](int step) {
        if (step + 1 < kNumThresholds && counts[step] < min_k) {
          return std::numeric_limits<double>::infinity();
        }
        return value(std::max(min_k, counts[step]), LadderThresholdPx(step));
      },
      false);
}

template <class Alpha>
NfaTerm PaperTrifocalTerm(const LogFactorials& factorials, int n,
                          const LadderCounts& counts, const Alpha& alpha) {
  return PaperMinimum(n, 2, counts, [&](int k, double e) {
    return std::log10(n - 1.0) + factorials.Log10Binomial(n, k) +
           std::log10(k) + (k - 1) * std::log10(alpha(e));
  });
}

}  // namespace

LogFactorials::LogFactorials(int max_n)
    : table_(static_cast<std::size_t>(std::max(0, max_n)) + 1, 0.0) {
  for (std::size_t n = 2; n < table_.size(); ++n) {
    table_[n] = table_[n - 1] + std::log10(static_cast<double>(n));
  }
}

double BestOfPartners(double alpha, double num_partners) {
  if (alpha >= 1.0) return 1.0;
  return -std::expm1(num_partners * std::log1p(-alpha));
}

double Log10ChanceOfSet(const LogFactorials& factorials, int n, int k,
                        double log10_alpha) {
  if (k <= 0) return 0.0;
  return factorials.Log10Binomial(n, k) + k * std::min(0.0, log10_alpha);
}

NfaTerm LeastOverSteps(const LadderValues& values) {
  return MinimumOverSteps([&](int step) { return values[step]; }, true);
}

LadderValues CalibratedValues(const LogFactorials& factorials, int n,
                              const LadderCounts& counts,
                              const LadderProbabilities& log10_alpha,
                              int sampled) {
  LadderValues values{};
  if (n <= sampled) return values;
  static const double kLog10Tests =
      std::log10(static_cast<double>(kNumThresholds));
  for (int step = 0; step < kNumThresholds; ++step) {
    values[step] = kLog10Tests + Log10ChanceOfSet(factorials, n - sampled,
                                                  counts[step] - sampled,
                                                  log10_alpha[step]);
  }
  return values;
}

PairLadderValues CalibratedPairValues(const LogFactorials& factorials, int n_a,
                                      const LadderCounts& counts_a,
                                      const LadderProbabilities& log10_alpha_a,
                                      int n_b, const LadderCounts& counts_b,
                                      const LadderProbabilities& log10_alpha_b,
                                      int sampled) {
  PairLadderValues values;
  if (n_a <= sampled && n_b <= sampled) return values;
  static const double kLog10Tests =
      std::log10(static_cast<double>(kNumThresholds));
  for (int step = 0; step < kNumThresholds; ++step) {
    const double a =
        Log10ChanceOfSet(factorials, n_a - sampled, counts_a[step] - sampled,
                         log10_alpha_a[step]);
    const double b =
        Log10ChanceOfSet(factorials, n_b - sampled, counts_b[step] - sampled,
                         log10_alpha_b[step]);
    values.log10_nfa[step] = kLog10Tests + std::max(a, b);
    values.order[step] = kLog10Tests + 0.5 * (a + b);
  }
  return values;
}

NfaTerm PaperPointTerm(const LogFactorials& factorials, int n,
                       const LadderCounts& counts, double image_area_px2) {
  return PaperTrifocalTerm(factorials, n, counts, [&](double e) {
    return kPi * e * e / image_area_px2;
  });
}

NfaTerm PaperLineTerm(const LogFactorials& factorials, int n,
                      const LadderCounts& counts, double image_area_px2,
                      double image_diagonal_px) {
  return PaperTrifocalTerm(factorials, n, counts, [&](double e) {
    return 2 * image_diagonal_px * e / image_area_px2;
  });
}

NfaTerm PaperCoplanarTerm(const LogFactorials& factorials, int n,
                          const LadderCounts& counts, double image_area_px2,
                          int num_neighbors) {
  return PaperMinimum(n, 3, counts, [&](int k, double e) {
    return std::log10(n - 2.0) +
           std::log10(static_cast<double>(n) * num_neighbors) +
           factorials.Log10Binomial(n, k - 2) +
           (k - 2) * std::log10(kPi * e * e / image_area_px2);
  });
}

}  // namespace lowlap
