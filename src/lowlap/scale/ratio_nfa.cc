#include "lowlap/scale/ratio_nfa.h"

#include <algorithm>
#include <cmath>

namespace lowlap {
namespace {

// Ratios at which the features of one kind are unrelated to the hypothesis:
// the kind's own ratios by rank, each displaced both ways by quantiles of a
// logistic, in an order that is the same read from either end.
std::vector<double> BackgroundRatios(
    const std::vector<RatioCandidate>& ratios) {
  constexpr int kErrorsWanted = 16384;
  constexpr double kGolden = 0.61803398874989485;
  const int n = static_cast<int>(ratios.size());
  std::vector<double> sorted;
  for (const RatioCandidate& ratio : ratios) sorted.push_back(ratio.log_ratio);
  std::sort(sorted.begin(), sorted.end());
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

// Every hypothesis, and every choice of the kinds that speak (are not capped);
// once more 2 as a margin, since the background is measured on few features.
double Log10Tests(const RatioSupport& support) {
  const int num_kinds = (support.num_points() > 0) + (support.num_lines() > 0) +
                        (support.num_pairs() > 0);
  const double num_hypotheses =
      std::max<double>(1.0, static_cast<double>(support.hypotheses().size()));
  return std::log10(num_hypotheses) + (num_kinds + 1) * std::log10(2.0);
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
      factorials_(std::max(
          {support.num_points(), support.num_lines(),
           support.num_coplanar_first() + support.num_coplanar_last()})) {
  if (form_ == NfaForm::kPaper) return;
  point_density_ = RatioDensity(support.Ratios(FeatureKind::kPoint));
  line_density_ = RatioDensity(support.Ratios(FeatureKind::kLine));
  coplanar_density_ = RatioDensity(support.Ratios(FeatureKind::kCoplanar));
  MeasureBackground(triplet);
}

void RatioNfaCriterion::MeasureBackground(const TripletView& triplet) {
  struct Law {
    LadderCounts SupportCounts::*counts;
    int num_features;
    LadderProbabilities* log10_alpha;
  };
  SupportWorkspace workspace;
  const auto measure = [&](FeatureKind kind, const std::vector<Law>& laws) {
    if (support_.Ratios(kind).empty()) return;
    const std::vector<double> ratios = BackgroundRatios(support_.Ratios(kind));
    std::vector<LadderSums> sums(laws.size(), LadderSums{});
    for (const double log_ratio : ratios) {
      const SupportCounts counts =
          support_.CountKind(kind, log_ratio, &workspace);
      for (std::size_t l = 0; l < laws.size(); ++l) {
        for (int step = 0; step < kNumThresholds; ++step) {
          sums[l][step] += (counts.*laws[l].counts)[step];
        }
      }
    }
    for (std::size_t l = 0; l < laws.size(); ++l) {
      const double num_features = laws[l].num_features;
      const double num_ratios = static_cast<double>(ratios.size());
      const double num_own = static_cast<double>(support_.Ratios(kind).size());
      *laws[l].log10_alpha = Log10Law(sums[l], num_features * num_ratios,
                                      num_own / num_features, triplet);
    }
  };
  measure(FeatureKind::kPoint, {{&SupportCounts::points, support_.num_points(),
                                 &background_.points}});
  measure(FeatureKind::kLine,
          {{&SupportCounts::lines, support_.num_lines(), &background_.lines}});
  measure(FeatureKind::kCoplanar,
          {{&SupportCounts::coplanar_first, support_.num_coplanar_first(),
            &background_.coplanar_first},
           {&SupportCounts::coplanar_last, support_.num_coplanar_last(),
            &background_.coplanar_last}});
}

RatioNfa RatioNfaCriterion::Evaluate(double log_ratio,
                                     const SupportCounts& counts,
                                     FeatureKind sampled) const {
  RatioNfa nfa;
  if (form_ == NfaForm::kPaper) {
    LadderCounts coplanar{};
    for (int step = 0; step < kNumThresholds; ++step) {
      coplanar[step] = counts.coplanar_first[step] + counts.coplanar_last[step];
    }
    nfa.points = PaperPointTerm(factorials_, support_.num_points(),
                                counts.points, image_area_px2_);
    nfa.lines = PaperLineTerm(factorials_, support_.num_lines(), counts.lines,
                              image_area_px2_, image_diagonal_px_);
    nfa.coplanar = PaperCoplanarTerm(
        factorials_,
        support_.num_coplanar_first() + support_.num_coplanar_last(), coplanar,
        image_area_px2_, num_neighbors_);
  } else {
    const auto law = [&](const LadderProbabilities& mean,
                         const RatioDensity& density) {
      const double log10_relative = density.Log10Relative(log_ratio);
      LadderProbabilities scaled = mean;
      for (double& log10_alpha : scaled) log10_alpha += log10_relative;
      return scaled;
    };
    nfa.points =
        CalibratedTerm(factorials_, support_.num_points(), counts.points,
                       law(background_.points, point_density_),
                       sampled == FeatureKind::kPoint);
    nfa.lines = CalibratedTerm(factorials_, support_.num_lines(), counts.lines,
                               law(background_.lines, line_density_),
                               sampled == FeatureKind::kLine);
    nfa.coplanar = CalibratedPairTerm(
        factorials_, support_.num_coplanar_first(), counts.coplanar_first,
        law(background_.coplanar_first, coplanar_density_),
        support_.num_coplanar_last(), counts.coplanar_last,
        law(background_.coplanar_last, coplanar_density_),
        sampled == FeatureKind::kCoplanar);
    nfa.log10_nfa = log10_tests_;
    nfa.uncapped = nfa.log10_nfa;
  }
  for (const NfaTerm* term : {&nfa.points, &nfa.lines, &nfa.coplanar}) {
    nfa.log10_nfa += term->log10_nfa;
    nfa.uncapped += term->uncapped;
  }
  return nfa;
}

}  // namespace lowlap
