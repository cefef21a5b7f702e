#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/internal/search/ratio_search.h"
#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"
#include "lowlap/scale/scale_estimator.h"

namespace lowlap {
namespace {

struct Agreement {
  int inliers = 0;
  double error_sum_px = 0;

  bool BetterThan(const Agreement& other) const {
    return inliers != other.inliers ? inliers > other.inliers
                                    : error_sum_px < other.error_sum_px;
  }
};

}  // namespace

FixedThresholdScaleEstimator::FixedThresholdScaleEstimator(EvidenceKinds kinds,
                                                           double threshold_px,
                                                           NfaForm form,
                                                           RatioSearch search)
    : ScaleEstimator(std::move(kinds)),
      threshold_px_(threshold_px),
      form_(form),
      search_(search) {}

Result<ScaleRatio> FixedThresholdScaleEstimator::Judge(
    const TripletView& triplet, const TripletEvidence& evidence) const {
  const RatioSupport support(evidence);
  ScaleRatio ratio = EmptyRatio(triplet, evidence);
  const std::vector<Hypothesis>& hypotheses = support.hypotheses();
  if (hypotheses.empty()) return ratio;

  std::vector<float> errors_px;
  const auto agreement_of = [&](int index) {
    Agreement agreement;
    const double tau = std::exp(hypotheses[index].log_ratio);
    for (int k = 0; k < support.num_kinds(); ++k) {
      const int count = support.kind(k).size();
      errors_px.resize(count);
      support.kind(k).Errors(tau, count, errors_px.data());
      for (const float error_px : errors_px) {
        if (!(error_px < threshold_px_)) continue;
        ++agreement.inliers;
        agreement.error_sum_px += error_px;
      }
    }
    return agreement;
  };
  const int best = SearchRatios(hypotheses, search_ == RatioSearch::kExhaustive,
                                agreement_of);

  SupportWorkspace workspace;
  const RatioNfaCriterion criterion(support, triplet, form_);
  const double log_ratio = hypotheses[best].log_ratio;
  RecordNfa(criterion.Evaluate(log_ratio, support.Count(log_ratio, &workspace)),
            support, &ratio);
  ratio.verdict = agreement_of(best).inliers > 1 ? RatioVerdict::kMeaningful
                                                 : RatioVerdict::kNotMeaningful;
  InlierThresholds thresholds;
  for (int k = 0; k < support.num_kinds(); ++k) {
    thresholds.push_back({threshold_px_, support.kind(k).size()});
  }
  RefineOnInliers(triplet, support, thresholds, log_ratio, &ratio);
  for (KindSupport& kind : ratio.kinds) kind.threshold_px = threshold_px_;
  return ratio;
}

}  // namespace lowlap
