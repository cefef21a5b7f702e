#include "lowlap/scale/internal/criterion/ratio_nfa.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lowlap/scale/internal/criterion/even_rank.h"

namespace lowlap {
namespace {

// Ratios at which the candidates of one kind are unrelated to the hypothesis:
// the kind's own ratios by rank, each displaced both ways by quantiles of a
// logistic, in an order that is the same read from either end.
std::vector<double> BackgroundRatios(const std::vector<double>& sorted) {
  constexpr int kErrorsWanted = 16384;
  constexpr double kGolden = 0.61803398874989485;
  const int n = static_cast<int>(sorted.size());
  const int draws = std::clamp(kErrorsWanted / (2 * n), 16, 256);
  std::vector<double> background;
  for (int m = 0; m < draws; ++m) {
    const std::size_t rank = EvenRank(m, draws, n);
    const double rotation = (std::min(m, draws - 1 - m) + 0.5) * kGolden;
    const double u =
        0.5 + 0.5 * (rotation - std::floor(rotation));  // in [0.5, 1)
    const double displacement = RatioDensity::kSpread * std::log(u / (1.0 - u));
    background.push_back(sorted[rank] - displacement);
    background.push_back(sorted[rank] + displacement);
  }
  return background;
}

using LadderSums = std::array<double, kNumThresholds>;

// log10 probabilities from the inliers counted among `num_errors` > 0 errors,
// each the least of `mean_partners`.
LadderProbabilities Log10Law(const LadderSums& counts, double num_errors,
                             double mean_partners, const TripletView& triplet) {
  LadderProbabilities law;
  double above = 0;  // probability per pixel at the next step
  for (int step = kNumThresholds - 1; step >= 0; --step) {
    const double e = LadderThresholdPx(step);
    const double uniform = BestOfPartners(
        2 * triplet.image_diagonal_px * e / triplet.image_area_px2,
        mean_partners);
    const double measured = counts[step] / num_errors;
    const double alpha =
        std::min(1.0, std::max({measured, above * e, uniform}));
    above = alpha / e;
    law[step] = std::log10(alpha);
  }
  return law;
}

// Every ratio that is tried, and what the kinds together gain by chance: the
// product of m uniform numbers is below x with probability
// x sum_j<m (-ln x)^j / j!, which for x around 1 / 500 is 1, 7, 26 and 67 times
// x, and so on. More for one and for two kinds, since the background is
// measured on few features.
double Log10Tests(const RatioSupport& support) {
  double num_tried = 0;
  for (int k = 0; k < support.num_kinds(); ++k) {
    num_tried += support.kind(k).NumTests();
  }
  constexpr std::array<double, 5> kByKinds = {1, 4, 8, 26, 67};
  constexpr int kTabulated = static_cast<int>(kByKinds.size()) - 1;
  const double kMinusLogX = std::log(500.0);
  double by_kinds = kByKinds[std::min(support.num_kinds(), kTabulated)];
  for (int j = kTabulated; j < support.num_kinds(); ++j) {
    by_kinds += std::pow(kMinusLogX, j) / std::tgamma(j + 1.0);
  }
  return std::log10(std::max(1.0, num_tried)) + std::log10(by_kinds);
}

LadderProbabilities Scaled(LadderProbabilities law, double log10_relative) {
  for (double& log10_alpha : law) log10_alpha += log10_relative;
  return law;
}

int MostUnits(const RatioSupport& support) {
  int most = 0;
  for (int k = 0; k < support.num_kinds(); ++k) {
    const auto& num_units = support.kind(k).units().tiers.back().num_units;
    most = std::max(most, num_units[0] + num_units[1]);
  }
  return most;
}

}  // namespace

RatioNfaCriterion::RatioNfaCriterion(const RatioSupport& support,
                                     const TripletView& triplet, NfaForm form)
    : support_(support),
      form_(form),
      log10_tests_(form == NfaForm::kPaper ? 0.0 : Log10Tests(support)),
      factorials_(MostUnits(support)),
      backgrounds_(support.num_tiers()),
      values_(support.num_tiers()),
      choices_(support.num_kinds()) {
  if (form_ == NfaForm::kPaper) return;
  for (int k = 0; k < support.num_kinds(); ++k) {
    if (const auto law = support.kind(k).Background()) {
      for (int t = 0; t < support.kind(k).units().num_tiers(); ++t) {
        backgrounds_[support.FirstTier(k) + t].log10_alpha = {*law, *law};
      }
    } else {
      MeasureBackground(k, triplet);
    }
  }
}

void RatioNfaCriterion::MeasureBackground(int kind,
                                          const TripletView& triplet) {
  SupportWorkspace workspace;
  const EvidenceUnits& units = support_.kind(kind).units();
  SupportCounts counts(units.num_tiers() * units.num_sides);
  for (int t = 0; t < units.num_tiers(); ++t) {
    const EvidenceUnits::Tier& tier = units.tiers[t];
    if (tier.num_candidates == 0) continue;
    Background& background = backgrounds_[support_.FirstTier(kind) + t];
    const std::vector<double> sorted =
        support_.SortedLogRatios(kind, tier.num_candidates);
    background.density = RatioDensity(sorted);
    std::array<LadderSums, 2> sums{};
    double num_draws = 0;
    for (const double log_ratio : BackgroundRatios(sorted)) {
      support_.CountKind(kind, log_ratio, t, &workspace, counts.data());
      for (int side = 0; side < units.num_sides; ++side) {
        for (int step = 0; step < kNumThresholds; ++step) {
          sums[side][step] += counts[t * units.num_sides + side][step];
        }
      }
      ++num_draws;
    }
    for (int side = 0; side < units.num_sides; ++side) {
      const double num_units = tier.num_units[side];
      background.log10_alpha[side] =
          Log10Law(sums[side], num_draws * num_units,
                   tier.num_candidates / num_units, triplet);
    }
  }
}

RatioNfa RatioNfaCriterion::Evaluate(double log_ratio,
                                     const SupportCounts& counts) const {
  if (form_ == NfaForm::kPaper) return EvaluatePaper(counts);
  FindValues(counts, [&](int tier) {
    return backgrounds_[tier].density.Log10Relative(log_ratio);
  });
  return LeastOverChoices();
}

RatioNfa RatioNfaCriterion::EvaluatePaper(const SupportCounts& counts) const {
  RatioNfa nfa;
  for (int k = 0; k < support_.num_kinds(); ++k) {
    const EvidenceUnits& units = support_.kind(k).units();
    const int last = units.num_tiers() - 1;
    const NfaTerm term = support_.kind(k).PaperTerm(
        factorials_,
        &counts[support_.FirstCounter(k) + last * units.num_sides]);
    nfa.kinds.push_back({term, last, term.log10_nfa < 0});
    nfa.log10_nfa += term.log10_nfa;
    nfa.uncapped += term.uncapped;
  }
  return nfa;
}

template <class Density>
void RatioNfaCriterion::FindValues(const SupportCounts& counts,
                                   const Density& log10_density) const {
  for (int k = 0; k < support_.num_kinds(); ++k) {
    const EvidenceUnits& units = support_.kind(k).units();
    const double log10_tiers =
        units.num_tiers() > 1 ? std::log10(units.num_tiers()) : 0.0;
    for (int t = 0; t < units.num_tiers(); ++t) {
      const EvidenceUnits::Tier& tier = units.tiers[t];
      if (tier.num_candidates == 0) continue;
      const int at = support_.FirstTier(k) + t;
      const LadderCounts* of_tier =
          &counts[support_.FirstCounter(k) + t * units.num_sides];
      std::array<LadderProbabilities, 2> law;
      const double density = log10_density(at);
      for (int side = 0; side < units.num_sides; ++side) {
        law[side] = Scaled(backgrounds_[at].log10_alpha[side], density);
      }
      const auto values = [&](int sampled) {
        PairLadderValues of_sample;
        if (units.num_sides == 1) {
          of_sample.log10_nfa = of_sample.order = CalibratedValues(
              factorials_, tier.num_units[0], of_tier[0], law[0], sampled);
        } else {
          of_sample = CalibratedPairValues(
              factorials_, tier.num_units[0], of_tier[0], law[0],
              tier.num_units[1], of_tier[1], law[1], sampled);
        }
        for (double& value : of_sample.log10_nfa) value += log10_tiers;
        for (double& value : of_sample.order) value += log10_tiers;
        return of_sample;
      };
      values_[at] = {values(0), values(1)};
    }
  }
}

RatioNfaCriterion::Choice RatioNfaCriterion::LeastChoice(int kind,
                                                         double limit) const {
  const EvidenceUnits& units = support_.kind(kind).units();
  Choice least;
  for (int t = 0; t < units.num_tiers(); ++t) {
    if (units.tiers[t].num_candidates == 0) continue;
    const TierValues& values = values_[support_.FirstTier(kind) + t];
    for (int step = 0; step < kNumThresholds; ++step) {
      const Choice choice = {values.unsampled.log10_nfa[step],
                             std::min(0.0, values.sampled.log10_nfa[step]), t,
                             step};
      if (choice.unsampled < least.unsampled && choice.Loss() < limit) {
        least = choice;
      }
    }
  }
  return least;
}

KindNfa RatioNfaCriterion::LeastUncapped(
    int kind, PairLadderValues TierValues::*values) const {
  const EvidenceUnits& units = support_.kind(kind).units();
  KindNfa best;
  best.uncapped = std::numeric_limits<double>::infinity();
  for (int t = 0; t < units.num_tiers(); ++t) {
    if (units.tiers[t].num_candidates == 0) continue;
    const NfaTerm term =
        LeastOverSteps((values_[support_.FirstTier(kind) + t].*values).order);
    if (term.uncapped < best.uncapped) best = {term, t, false};
  }
  best.log10_nfa = 0;
  return best;
}

RatioNfa RatioNfaCriterion::LeastUncapped() const {
  RatioNfa nfa;
  nfa.log10_nfa = nfa.uncapped = log10_tests_;
  KindNfa sample;
  int sampled = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < support_.num_kinds(); ++k) {
    nfa.kinds.push_back(LeastUncapped(k, &TierValues::unsampled));
    const KindNfa with_sample = LeastUncapped(k, &TierValues::sampled);
    const double loss = with_sample.uncapped - nfa.kinds[k].uncapped;
    if (loss <= most) continue;
    most = loss;
    sampled = k;
    sample = with_sample;
  }
  if (!nfa.kinds.empty()) nfa.kinds[sampled] = sample;
  for (const KindNfa& kind : nfa.kinds) nfa.uncapped += kind.uncapped;
  return nfa;
}

RatioNfa RatioNfaCriterion::LeastOverChoices() const {
  RatioNfa nfa = LeastUncapped();
  const int num_kinds = support_.num_kinds();
  for (int k = 0; k < num_kinds; ++k) {
    choices_[k] = LeastChoice(k, std::numeric_limits<double>::infinity());
  }
  // The best choices, then the best that lose less and less.
  while (true) {
    int sampled = 0;
    for (int k = 1; k < num_kinds; ++k) {
      if (choices_[k].Loss() > choices_[sampled].Loss()) sampled = k;
    }
    double witnesses = log10_tests_, total = log10_tests_;
    for (int k = 0; k < num_kinds; ++k) {
      const Choice& choice = choices_[k];
      witnesses += choice.unsampled;
      total += k == sampled ? choice.sampled : choice.unsampled;
    }
    if (!(witnesses < nfa.log10_nfa)) return nfa;
    if (total < nfa.log10_nfa) {
      nfa.log10_nfa = total;
      for (int k = 0; k < num_kinds; ++k) {
        const Choice& choice = choices_[k];
        KindNfa& kind = nfa.kinds[k];
        kind.speaks = choice.unsampled < 0;
        kind.log10_nfa = k == sampled ? choice.sampled : choice.unsampled;
        // How far the inliers of pairs reach, both sides tell.
        if (!kind.speaks || support_.kind(k).units().num_sides > 1) continue;
        kind.tier = choice.tier;
        kind.step = choice.step;
      }
    }
    const double limit = choices_[sampled].Loss();
    for (int k = 0; k < num_kinds; ++k) {
      if (choices_[k].Loss() >= limit) choices_[k] = LeastChoice(k, limit);
    }
  }
}

RatioNfaBound RatioNfaCriterion::Bound(double low, double high,
                                       const SupportCounts& most) const {
  FindValues(most, [&](int tier) {
    return backgrounds_[tier].density.LeastLog10Relative(low, high);
  });
  RatioNfaBound bound;
  bound.log10_nfa = LeastOverChoices().log10_nfa;
  bound.tiers.resize(support_.num_tiers());

  std::vector<double> best;  // of every kind, unsampled
  double all = log10_tests_;
  for (int k = 0; k < support_.num_kinds(); ++k) {
    best.push_back(
        LeastChoice(k, std::numeric_limits<double>::infinity()).unsampled);
    all += best.back();
  }
  for (int k = 0; k < support_.num_kinds(); ++k) {
    for (int t = 0; t < support_.kind(k).units().num_tiers(); ++t) {
      const int at = support_.FirstTier(k) + t;
      for (int step = 0; step < kNumThresholds; ++step) {
        // The most that any kind loses is no less than what this one does.
        bound.tiers[at][step] =
            values_[at].unsampled.log10_nfa[step] < 0
                ? all - best[k] +
                      std::min(0.0, values_[at].sampled.log10_nfa[step])
                : std::numeric_limits<double>::infinity();
      }
    }
  }
  return bound;
}

}  // namespace lowlap
