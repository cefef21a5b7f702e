#include "lowlap/scale/scale_ratios.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scale/internal/triplet_rounds.h"
#include "lowlap/scale/internal/unrepeated_scene.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

bool Disagree(const ScaleRatio& a, const ScaleRatio& b) {
  constexpr double kDisagrees = 6;
  return std::abs(a.log_ratio - b.log_ratio) >
         kDisagrees * std::hypot(a.log_ratio_stddev, b.log_ratio_stddev);
}

template <class Test>
Status HearWhatDoesNotRepeat(const Scene& scene, const EvidenceKinds& kinds,
                             const RunContext& context, const Test& test,
                             std::vector<ScaleRatio>* ratios) {
  constexpr double kMaxLog10Nfa = -3;
  const UnrepeatedScene unrepeated = WithoutRepeatedMatches(scene);
  std::vector<ScaleRatio*> asked;
  std::vector<ViewTriplet> triplets;
  for (ScaleRatio& ratio : *ratios) {
    const auto& [first, middle, last] = ratio.views;
    if (ratio.verdict == RatioVerdict::kMeaningful &&
        (unrepeated.changed.count(OrderedPair(first, middle)) > 0 ||
         unrepeated.changed.count(OrderedPair(middle, last)) > 0)) {
      asked.push_back(&ratio);
      triplets.push_back(ratio.views);
    }
  }
  if (asked.empty()) return {};
  LOWLAP_ASSIGN_OR_RETURN(std::vector<ScaleRatio> others,
                          TestTriplets<ScaleRatio>(
                              unrepeated.scene, triplets, kinds, context,
                              "scale ratios of what does not repeat", test, 1));
  for (std::size_t n = 0; n < asked.size(); ++n) {
    ScaleRatio &ratio = *asked[n], &other = others[n];
    if (other.verdict != RatioVerdict::kMeaningful) {
      ratio.verdict = RatioVerdict::kNotMeaningful;
      ratio.log10_nfa = std::max(0.0, other.log10_nfa);
    } else if (other.log10_nfa < kMaxLog10Nfa && Disagree(other, ratio)) {
      other.second_mode = RatioMode{ratio.log_ratio, ratio.log10_nfa};
      ratio = std::move(other);
    }
  }
  return {};
}

}  // namespace

Result<std::vector<ScaleRatio>> EstimateScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleEstimator& estimator, const RunContext& context) {
  const auto test = [&](const TripletView& triplet,
                        const TripletEvidence& evidence) {
    return estimator.Estimate(triplet, evidence);
  };
  LOWLAP_ASSIGN_OR_RETURN(
      std::vector<ScaleRatio> ratios,
      TestTriplets<ScaleRatio>(scene, triplets, estimator.kinds(), context,
                               "scale ratios", test));
  LOWLAP_RETURN_IF_ERROR(
      HearWhatDoesNotRepeat(scene, estimator.kinds(), context, test, &ratios));
  return ratios;
}

Result<std::vector<ScaleRatio>> EstimateScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  return EstimateScaleRatios(scene, triplets, *MakeScaleEstimator(options),
                             context);
}

Result<std::vector<ScaleRatio>> EstimateScaleRatios(const Scene& scene,
                                                    const ScaleOptions& options,
                                                    const RunContext& context) {
  return EstimateScaleRatios(scene, FindTriplets(ViewGraph(scene)), options,
                             context);
}

}  // namespace lowlap
