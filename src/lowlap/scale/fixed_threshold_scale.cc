#include "lowlap/scale/fixed_threshold_scale.h"

#include <vector>

#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/internal/search/ratio_search.h"
#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"

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

Result<ScaleRatio> FixedThresholdScaleEstimator::Estimate(
    const TripletView& triplet) const {
  if (const Status status = CheckTriplet(triplet); !status) {
    return tl::unexpected<Error>(status.error());
  }
  const RatioSupport support(triplet, options_);
  ScaleRatio ratio = EmptyRatio(triplet, support);
  const std::vector<Hypothesis>& hypotheses = support.hypotheses();
  if (hypotheses.empty()) return ratio;

  std::vector<float> errors_px;
  const auto agreement_of = [&](int index) {
    Agreement agreement;
    for (const FeatureKind kind : kFeatureKinds) {
      support.Errors(kind, hypotheses[index].log_ratio, &errors_px);
      for (const float error_px : errors_px) {
        if (!(error_px < options_.threshold_px)) continue;
        ++agreement.inliers;
        agreement.error_sum_px += error_px;
      }
    }
    return agreement;
  };
  const int best = SearchRatios(
      hypotheses, options_.search == RatioSearch::kExhaustive, agreement_of);

  SupportWorkspace workspace;
  const RatioNfaCriterion criterion(support, triplet, options_);
  const RatioNfa nfa = criterion.Evaluate(
      hypotheses[best], support.Count(hypotheses[best].log_ratio, &workspace));
  ratio.log10_nfa = nfa.log10_nfa;
  ratio.points.log10_nfa = nfa.points.log10_nfa;
  ratio.lines.log10_nfa = nfa.lines.log10_nfa;
  ratio.coplanar.log10_nfa =
      nfa.coplanar.log10_nfa + nfa.plane_points.log10_nfa;
  ratio.verdict = agreement_of(best).inliers > 1 ? RatioVerdict::kMeaningful
                                                 : RatioVerdict::kNotMeaningful;
  const InlierThresholds thresholds{
      options_.threshold_px, options_.threshold_px, options_.threshold_px,
      options_.threshold_px, support.num_pairs()};
  RefineOnInliers(triplet, support, thresholds, hypotheses[best].log_ratio,
                  &ratio);
  return ratio;
}

}  // namespace lowlap
