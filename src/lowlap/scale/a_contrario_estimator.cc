#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/internal/search/ratio_search.h"
#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "lowlap/scale/internal/search/second_mode.h"
#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"
#include "lowlap/scale/scale_estimator.h"

namespace lowlap {
namespace {

RatioOptimum FindOptimum(const RatioSupport& support,
                         const RatioNfaCriterion& criterion, NfaForm form,
                         RatioSearch search) {
  if (search == RatioSearch::kSweep && form == NfaForm::kCalibrated) {
    RatioOptimum optimum = SweepRatios(support, criterion);
    if (optimum.nfa.log10_nfa < 0) return optimum;
    // Chance explains the optimum: a ratio that a candidate asks for is the
    // better guess.
  }
  const std::vector<Hypothesis>& hypotheses = support.hypotheses();
  SupportWorkspace workspace;
  const auto nfa_of = [&](int index) {
    const double log_ratio = hypotheses[index].log_ratio;
    return criterion.Evaluate(log_ratio, support.Count(log_ratio, &workspace));
  };
  const int best =
      SearchRatios(hypotheses, search == RatioSearch::kExhaustive, nfa_of);
  return {hypotheses[best].log_ratio, nfa_of(best)};
}

// Two tests find twice as many false ratios.
void PayForTests(int num_tests, ScaleRatio* ratio) {
  if (num_tests == 1) return;
  const double log10_tests = std::log10(static_cast<double>(num_tests));
  ratio->log10_nfa += log10_tests;
  if (ratio->second_mode) ratio->second_mode->log10_nfa += log10_tests;
  if (!(ratio->log10_nfa < 0)) ratio->verdict = RatioVerdict::kNotMeaningful;
}

}  // namespace

AContrarioScaleEstimator::AContrarioScaleEstimator(EvidenceKinds kinds,
                                                   NfaForm form,
                                                   RatioSearch search)
    : ScaleEstimator(std::move(kinds)), form_(form), search_(search) {}

Result<ScaleRatio> AContrarioScaleEstimator::Judge(
    const TripletView& triplet, const TripletEvidence& evidence) const {
  const RatioSupport support(evidence);
  ScaleRatio ratio = EmptyRatio(triplet, evidence);
  if (support.hypotheses().empty()) return ratio;

  const RatioNfaCriterion criterion(support, triplet, form_);
  const RatioOptimum optimum = FindOptimum(support, criterion, form_, search_);
  const RatioNfa& nfa = optimum.nfa;
  RecordNfa(nfa, support, &ratio);
  const bool meaningful = nfa.log10_nfa < 0;
  ratio.verdict =
      meaningful ? RatioVerdict::kMeaningful : RatioVerdict::kNotMeaningful;

  InlierThresholds thresholds;
  for (int k = 0; k < support.num_kinds(); ++k) {
    const KindNfa& of_kind = nfa.kinds[k];
    const bool speaks = !meaningful || of_kind.speaks;
    thresholds.push_back(
        {speaks ? LadderThresholdPx(of_kind.step) : 0.0,
         support.kind(k).units().tiers[of_kind.tier].num_candidates});
  }
  RefineOnInliers(triplet, support, thresholds, optimum.log_ratio, &ratio);
  if (meaningful && form_ == NfaForm::kCalibrated) {
    if (const auto second = FindSecondMode(support, criterion, optimum)) {
      ratio.second_mode = RatioMode{second->log_ratio, second->nfa.log10_nfa};
    }
  }
  PayForTests(evidence.num_tests, &ratio);
  return ratio;
}

}  // namespace lowlap
