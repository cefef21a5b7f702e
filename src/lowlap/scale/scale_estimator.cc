#include "lowlap/scale/scale_estimator.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/evidence/evidence_registry.h"
#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/internal/search/ratio_search.h"
#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "lowlap/scale/internal/search/second_mode.h"
#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"

namespace lowlap {
namespace {

// The inverse of a relative pose within the tolerance is within three times it.
bool IsUnitTransform(const RigidTransform& transform) {
  constexpr double kTolerance = 3 * kUnitTolerance;
  return RotationDefect(transform.rotation) <= kTolerance &&
         std::abs(transform.translation.norm() - 1.0) <= kTolerance;
}

Status CheckTriplet(const TripletView& triplet) {
  const TripletGeometry& geometry = triplet.geometry;
  return Require(
      {{IsUnitTransform(geometry.cami_from_camj) &&
            IsUnitTransform(geometry.camk_from_camj),
        "a relative pose of the triplet is not a rotation with a unit "
        "direction"},
       {IsPositive(geometry.focal_i_px) && IsPositive(geometry.focal_j_px) &&
            IsPositive(geometry.focal_k_px) &&
            IsPositive(triplet.image_area_px2) &&
            IsPositive(triplet.image_diagonal_px),
        "a focal length or the image size of the triplet is not positive"}});
}

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

struct Agreement {
  int inliers = 0;
  double error_sum_px = 0;

  bool BetterThan(const Agreement& other) const {
    return inliers != other.inliers ? inliers > other.inliers
                                    : error_sum_px < other.error_sum_px;
  }
};

}  // namespace

bool ScaleOptions::Asks(const std::string& feature) const {
  return features.empty() ||
         std::find(features.begin(), features.end(), feature) != features.end();
}

Status ScaleOptions::Validate() const {
  const auto kinds = EvidenceRegistry::BuiltIn().Make(features, without);
  if (!kinds) return tl::unexpected<Error>(kinds.error());
  return Require(
      {{IsPositive(threshold_px), "the inlier threshold must be positive"}});
}

ScaleEstimator::ScaleEstimator(EvidenceKinds kinds)
    : kinds_(std::move(kinds)) {}

Result<ScaleRatio> ScaleEstimator::Estimate(const TripletView& triplet) const {
  LOWLAP_RETURN_IF_ERROR(CheckTriplet(triplet));
  return Estimate(triplet, GatherEvidence(kinds_, triplet));
}

Result<ScaleRatio> ScaleEstimator::Estimate(
    const TripletView& triplet, const TripletEvidence& evidence) const {
  LOWLAP_RETURN_IF_ERROR(CheckTriplet(triplet));
  return Judge(triplet, evidence);
}

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

std::unique_ptr<ScaleEstimator> MakeScaleEstimator(
    const ScaleOptions& options) {
  auto kinds =
      EvidenceRegistry::BuiltIn().Make(options.features, options.without);
  if (options.criterion == ScaleCriterion::kFixedThreshold) {
    return std::make_unique<FixedThresholdScaleEstimator>(
        std::move(*kinds), options.threshold_px, options.nfa_form,
        options.search);
  }
  return std::make_unique<AContrarioScaleEstimator>(
      std::move(*kinds), options.nfa_form, options.search);
}

}  // namespace lowlap
