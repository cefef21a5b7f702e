#include "lowlap/scale/a_contrario_scale.h"

#include <vector>

#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/internal/search/ratio_search.h"
#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "lowlap/scale/internal/search/second_mode.h"
#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"

namespace lowlap {
namespace {

RatioOptimum FindOptimum(const RatioSupport& support,
                         const RatioNfaCriterion& criterion,
                         const ScaleOptions& options) {
  if (options.search == RatioSearch::kSweep &&
      options.nfa_form == NfaForm::kCalibrated) {
    const RatioOptimum optimum = SweepRatios(support, criterion);
    if (optimum.nfa.log10_nfa < 0) return optimum;
    // Chance explains the optimum: a ratio that a feature asks for is the
    // better guess.
  }
  const std::vector<Hypothesis>& hypotheses = support.hypotheses();
  SupportWorkspace workspace;
  const auto nfa_of = [&](int index) {
    const Hypothesis& hypothesis = hypotheses[index];
    return criterion.Evaluate(hypothesis,
                              support.Count(hypothesis.log_ratio, &workspace));
  };
  const int best = SearchRatios(
      hypotheses, options.search == RatioSearch::kExhaustive, nfa_of);
  return {hypotheses[best].log_ratio, nfa_of(best)};
}

}  // namespace

Result<ScaleRatio> AContrarioScaleEstimator::Estimate(
    const TripletView& triplet) const {
  if (const Status status = CheckTriplet(triplet); !status) {
    return tl::unexpected<Error>(status.error());
  }
  const RatioSupport support(triplet, options_);
  ScaleRatio ratio = EmptyRatio(triplet, support);
  if (support.hypotheses().empty()) return ratio;

  const RatioNfaCriterion criterion(support, triplet, options_);
  const RatioOptimum optimum = FindOptimum(support, criterion, options_);
  const RatioNfa& nfa = optimum.nfa;
  ratio.log10_nfa = nfa.log10_nfa;
  ratio.points.log10_nfa = nfa.points.log10_nfa;
  ratio.lines.log10_nfa = nfa.lines.log10_nfa;
  ratio.coplanar.log10_nfa =
      nfa.coplanar.log10_nfa + nfa.plane_points.log10_nfa;
  ratio.verdict = nfa.log10_nfa < 0 ? RatioVerdict::kMeaningful
                                    : RatioVerdict::kNotMeaningful;

  const bool meaningful = ratio.verdict == RatioVerdict::kMeaningful;
  const auto threshold_px = [&](const NfaTerm& term, int num_features) {
    const bool speaks = num_features > 0 && (!meaningful || term.log10_nfa < 0);
    return speaks ? LadderThresholdPx(term.step) : 0.0;
  };
  const InlierThresholds thresholds{
      threshold_px(nfa.points, support.num_points()),
      threshold_px(nfa.lines, support.num_lines()),
      threshold_px(nfa.coplanar, support.num_pairs()),
      threshold_px(nfa.plane_points, support.num_plane_points()),
      support.Tier(nfa.coplanar_tier).num_pairs};
  RefineOnInliers(triplet, support, thresholds, optimum.log_ratio, &ratio);
  if (meaningful && options_.nfa_form == NfaForm::kCalibrated) {
    if (const auto second = FindSecondMode(support, criterion, optimum)) {
      ratio.second_mode = RatioMode{second->log_ratio, second->nfa.log10_nfa};
    }
  }
  return ratio;
}

}  // namespace lowlap
