#include "lowlap/scale/internal/criterion/ratio_nfa.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lowlap {
namespace {

// Ratios at which the features of one kind are unrelated to the hypothesis:
// the kind's own ratios by rank, each displaced both ways by quantiles of a
// logistic, in an order that is the same read from either end.
std::vector<double> BackgroundRatios(const std::vector<double>& sorted) {
  constexpr int kErrorsWanted = 16384;
  constexpr double kGolden = 0.61803398874989485;
  const int n = static_cast<int>(sorted.size());
  const int draws = std::clamp(kErrorsWanted / (2 * n), 16, 256);
  std::vector<double> background;
  for (int m = 0; m < draws; ++m) {
    const int rank = static_cast<int>((2LL * m + 1) * n / (2LL * draws));
    const double turns = (std::min(m, draws - 1 - m) + 0.5) * kGolden;
    const double u = 0.5 + 0.5 * (turns - std::floor(turns));  // in [0.5, 1)
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
// x. More for one and for two kinds, since the background is measured on few
// features. Tried are the ends of the intervals in which features are inliers.
// A point has one for each threshold, about one ratio, of which the threshold
// that decides tells the one that counts; the intervals of lines and pairs are
// several and overlap at random, so that every end counts.
double Log10Tests(const RatioSupport& support) {
  const int num_kinds = (support.num_points() > 0) + (support.num_lines() > 0) +
                        (support.num_pairs() > 0) +
                        (support.num_plane_points() > 0);
  const double num_tried =
      support.num_points() + support.num_plane_points() +
      kNumThresholds *
          static_cast<double>(support.num_lines() + support.num_pairs());
  constexpr double kByKinds[] = {1, 4, 8, 26, 67};
  return std::log10(std::max(1.0, num_tried)) + std::log10(kByKinds[num_kinds]);
}

LadderProbabilities Scaled(LadderProbabilities law, double log10_relative) {
  for (double& log10_alpha : law) log10_alpha += log10_relative;
  return law;
}

void AddUp(double log10_tests, RatioNfa* nfa) {
  nfa->log10_nfa = nfa->uncapped = log10_tests;
  for (const NfaTerm* term :
       {&nfa->points, &nfa->lines, &nfa->coplanar, &nfa->plane_points}) {
    nfa->log10_nfa += term->log10_nfa;
    nfa->uncapped += term->uncapped;
  }
}

}  // namespace

RatioNfaCriterion::RatioNfaCriterion(const RatioSupport& support,
                                     const TripletView& triplet,
                                     const ScaleOptions& options)
    : support_(support),
      form_(options.nfa_form),
      num_neighbors_(options.num_neighbors),
      image_area_px2_(triplet.image_area_px2),
      image_diagonal_px_(triplet.image_diagonal_px),
      log10_tests_(Log10Tests(support)),
      factorials_(std::max({support.num_points(), support.num_lines(),
                            support.num_plane_points(),
                            support.Tier(kPairTiers - 1).num_first +
                                support.Tier(kPairTiers - 1).num_last})) {
  if (form_ == NfaForm::kCalibrated) MeasureBackground(triplet);
}

void RatioNfaCriterion::MeasureBackground(const TripletView& triplet) {
  SupportWorkspace workspace;
  const auto add = [](const LadderCounts& counts, LadderSums* sums) {
    for (int step = 0; step < kNumThresholds; ++step) {
      (*sums)[step] += counts[step];
    }
  };
  const auto measure = [&](FeatureKind kind, int num_features,
                           Background* background) {
    if (num_features == 0) return;
    const std::vector<double> sorted =
        support_.SortedLogRatios(kind, num_features);
    background->density = RatioDensity(sorted);
    LadderSums sums{};
    double num_errors = 0;
    for (const double log_ratio : BackgroundRatios(sorted)) {
      add(kind == FeatureKind::kPoint
              ? support_.CountPoints(log_ratio, &workspace)
          : kind == FeatureKind::kLine
              ? support_.CountLines(log_ratio, &workspace)
              : support_.CountPlanePoints(log_ratio, &workspace),
          &sums);
      num_errors += num_features;
    }
    background->log10_alpha = Log10Law(sums, num_errors, 1, triplet);
  };
  measure(FeatureKind::kPoint, support_.num_points(), &points_);
  measure(FeatureKind::kLine, support_.num_lines(), &lines_);
  measure(FeatureKind::kPlanePoint, support_.num_plane_points(),
          &plane_points_);

  for (int t = 0; t < kPairTiers; ++t) {
    const PairTier& tier = support_.Tier(t);
    if (tier.num_pairs == 0) continue;
    const std::vector<double> sorted =
        support_.SortedLogRatios(FeatureKind::kCoplanar, tier.num_pairs);
    pairs_[t].density = RatioDensity(sorted);
    LadderSums first{}, last{};
    double num_draws = 0;
    for (const double log_ratio : BackgroundRatios(sorted)) {
      const PairCounts counts =
          support_.CountPairs(log_ratio, t, &workspace)[t];
      add(counts.first, &first);
      add(counts.last, &last);
      ++num_draws;
    }
    const double num_pairs = tier.num_pairs;
    pairs_[t].log10_alpha_first = Log10Law(first, num_draws * tier.num_first,
                                           num_pairs / tier.num_first, triplet);
    pairs_[t].log10_alpha_last = Log10Law(last, num_draws * tier.num_last,
                                          num_pairs / tier.num_last, triplet);
  }
}

RatioNfa RatioNfaCriterion::Evaluate(const Hypothesis& hypothesis,
                                     const SupportCounts& counts) const {
  RatioNfa nfa;
  if (form_ == NfaForm::kPaper) {
    EvaluatePaper(counts, &nfa);
  } else {
    EvaluateCalibrated(hypothesis, counts, &nfa);
  }
  return nfa;
}

void RatioNfaCriterion::EvaluatePaper(const SupportCounts& counts,
                                      RatioNfa* nfa) const {
  constexpr int kAll = kPairTiers - 1;
  LadderCounts coplanar{};
  for (int step = 0; step < kNumThresholds; ++step) {
    coplanar[step] =
        counts.coplanar[kAll].first[step] + counts.coplanar[kAll].last[step];
  }
  nfa->points = PaperPointTerm(factorials_, support_.num_points(),
                               counts.points, image_area_px2_);
  nfa->lines = PaperLineTerm(factorials_, support_.num_lines(), counts.lines,
                             image_area_px2_, image_diagonal_px_);
  nfa->coplanar = PaperCoplanarTerm(
      factorials_, support_.Tier(kAll).num_first + support_.Tier(kAll).num_last,
      coplanar, image_area_px2_, num_neighbors_);
  nfa->coplanar_tier = kAll;
  AddUp(0.0, nfa);
}

RatioNfaCriterion::Densities RatioNfaCriterion::DensitiesAt(
    double log_ratio) const {
  Densities densities{points_.density.Log10Relative(log_ratio),
                      lines_.density.Log10Relative(log_ratio),
                      plane_points_.density.Log10Relative(log_ratio)};
  for (int t = 0; t < kPairTiers; ++t) {
    densities[3 + t] = pairs_[t].density.Log10Relative(log_ratio);
  }
  return densities;
}

RatioNfaCriterion::AllValues RatioNfaCriterion::Values(
    const SupportCounts& counts, const Densities& densities) const {
  AllValues values;
  const auto fill = [&](int num_features, const LadderCounts& of_kind,
                        const LadderProbabilities& law, KindValues* kind) {
    if (num_features == 0) return;
    kind->unsampled =
        CalibratedValues(factorials_, num_features, of_kind, law, 0);
    kind->sampled =
        CalibratedValues(factorials_, num_features, of_kind, law, 1);
  };
  fill(support_.num_points(), counts.points,
       Scaled(points_.log10_alpha, densities[0]), &values.points);
  fill(support_.num_lines(), counts.lines,
       Scaled(lines_.log10_alpha, densities[1]), &values.lines);
  fill(support_.num_plane_points(), counts.plane_points,
       Scaled(plane_points_.log10_alpha, densities[2]), &values.plane_points);
  static const double kLog10Tiers = std::log10(static_cast<double>(kPairTiers));
  for (int t = 0; t < kPairTiers; ++t) {
    const PairTier& tier = support_.Tier(t);
    if (tier.num_pairs == 0) continue;
    const PairBackground& background = pairs_[t];
    const auto of_tier = [&](int sampled) {
      LadderValues pairs = CalibratedPairValues(
          factorials_, tier.num_first, counts.coplanar[t].first,
          Scaled(background.log10_alpha_first, densities[3 + t]), tier.num_last,
          counts.coplanar[t].last,
          Scaled(background.log10_alpha_last, densities[3 + t]), sampled);
      for (double& value : pairs) value += kLog10Tiers;
      return pairs;
    };
    values.coplanar[t] = {of_tier(0), of_tier(1)};
  }
  return values;
}

NfaTerm RatioNfaCriterion::LeastOverTiers(
    const std::array<KindValues, kPairTiers>& values, int sampled_tier,
    int* best_tier) const {
  NfaTerm best;
  *best_tier = 0;
  bool first_tier = true;
  for (int t = 0; t < kPairTiers; ++t) {
    if (support_.Tier(t).num_pairs == 0) continue;
    const NfaTerm term = LeastOverSteps(
        t >= sampled_tier ? values[t].sampled : values[t].unsampled);
    if (first_tier || term.uncapped < best.uncapped) {
      best = term;
      *best_tier = t;
    }
    first_tier = false;
  }
  return best;
}

void RatioNfaCriterion::EvaluateCalibrated(const Hypothesis& hypothesis,
                                           const SupportCounts& counts,
                                           RatioNfa* nfa) const {
  const AllValues values = Values(counts, DensitiesAt(hypothesis.log_ratio));
  nfa->points = LeastOverSteps(hypothesis.kind == FeatureKind::kPoint
                                   ? values.points.sampled
                                   : values.points.unsampled);
  nfa->lines = LeastOverSteps(hypothesis.kind == FeatureKind::kLine
                                  ? values.lines.sampled
                                  : values.lines.unsampled);
  nfa->plane_points = LeastOverSteps(hypothesis.kind == FeatureKind::kPlanePoint
                                         ? values.plane_points.sampled
                                         : values.plane_points.unsampled);
  const int tier_of_sample = hypothesis.kind == FeatureKind::kCoplanar
                                 ? support_.TierOfPair(hypothesis.index)
                                 : kPairTiers;
  nfa->coplanar =
      LeastOverTiers(values.coplanar, tier_of_sample, &nfa->coplanar_tier);
  AddUp(log10_tests_, nfa);
}

RatioNfa RatioNfaCriterion::EvaluateAt(double log_ratio,
                                       const SupportCounts& counts) const {
  return LeastOverKinds(Values(counts, DensitiesAt(log_ratio)));
}

RatioNfa RatioNfaCriterion::LeastOverKinds(const AllValues& values) const {
  RatioNfa unsampled;
  unsampled.points = LeastOverSteps(values.points.unsampled);
  unsampled.lines = LeastOverSteps(values.lines.unsampled);
  unsampled.plane_points = LeastOverSteps(values.plane_points.unsampled);
  unsampled.coplanar =
      LeastOverTiers(values.coplanar, kPairTiers, &unsampled.coplanar_tier);
  // A ratio from a pair of a wider tier is not a sample of the nearer ones.
  int last_tier = 0;
  for (int t = 1; t < kPairTiers; ++t) {
    if (support_.Tier(t).num_pairs > support_.Tier(t - 1).num_pairs) {
      last_tier = t;
    }
  }
  RatioNfa best;
  bool is_first = true;
  for (const FeatureKind kind : kFeatureKinds) {
    if (support_.Ratios(kind).empty()) continue;
    RatioNfa nfa = unsampled;
    if (kind == FeatureKind::kPoint) {
      nfa.points = LeastOverSteps(values.points.sampled);
    } else if (kind == FeatureKind::kLine) {
      nfa.lines = LeastOverSteps(values.lines.sampled);
    } else if (kind == FeatureKind::kPlanePoint) {
      nfa.plane_points = LeastOverSteps(values.plane_points.sampled);
    } else {
      nfa.coplanar =
          LeastOverTiers(values.coplanar, last_tier, &nfa.coplanar_tier);
    }
    AddUp(log10_tests_, &nfa);
    if (is_first || nfa.BetterThan(best)) best = nfa;
    is_first = false;
  }
  return best;
}

RatioNfaBound RatioNfaCriterion::Bound(double low, double high,
                                       const SupportCounts& most) const {
  const auto least_density = [&](const RatioDensity& density) {
    return density.LeastLog10Relative(low, high);
  };
  Densities densities{least_density(points_.density),
                      least_density(lines_.density),
                      least_density(plane_points_.density)};
  for (int t = 0; t < kPairTiers; ++t) {
    densities[3 + t] = least_density(pairs_[t].density);
  }
  const AllValues values = Values(most, densities);
  RatioNfaBound bound;
  bound.log10_nfa = LeastOverKinds(values).log10_nfa;

  // The kinds at their best, unsampled.
  int tier = 0;
  const double points = LeastOverSteps(values.points.unsampled).log10_nfa;
  const double lines = LeastOverSteps(values.lines.unsampled).log10_nfa;
  const double plane_points =
      LeastOverSteps(values.plane_points.unsampled).log10_nfa;
  const double coplanar =
      LeastOverTiers(values.coplanar, kPairTiers, &tier).log10_nfa;
  const double all = log10_tests_ + points + lines + plane_points + coplanar;
  // A kind alone is always the sampled one.
  int num_kinds = 0;
  for (const FeatureKind kind : kFeatureKinds) {
    num_kinds += !support_.Ratios(kind).empty();
  }
  const auto by_step = [&](const KindValues& of_kind, double best_of_kind) {
    LadderValues bounds;
    for (int step = 0; step < kNumThresholds; ++step) {
      const double value = num_kinds == 1 ? of_kind.sampled[step]
                                          : std::min(of_kind.sampled[step],
                                                     of_kind.unsampled[step]);
      bounds[step] = value < 0 ? all - best_of_kind + value
                               : std::numeric_limits<double>::infinity();
    }
    return bounds;
  };
  bound.points = by_step(values.points, points);
  bound.lines = by_step(values.lines, lines);
  bound.plane_points = by_step(values.plane_points, plane_points);
  for (int t = 0; t < kPairTiers; ++t) {
    // Pairs of a nearer tier may be unsampled although they are alone.
    KindValues of_tier = values.coplanar[t];
    if (t + 1 < kPairTiers) of_tier.sampled = of_tier.unsampled;
    bound.coplanar[t] = by_step(of_tier, coplanar);
  }
  return bound;
}

}  // namespace lowlap
