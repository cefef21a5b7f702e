#include "lowlap/scale/scale_ratios.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scale/internal/triplet_rounds.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

bool HasRepeats(const Scene& scene, const ViewTriplet& views) {
  const ViewId all[] = {views.first, views.middle, views.last};
  return std::any_of(std::begin(all), std::end(all), [&](ViewId view) {
    const auto found = scene.features.find(view);
    return found != scene.features.end() &&
           !(found->second.repeated_points.empty() &&
             found->second.repeated_segments.empty());
  });
}

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
  std::vector<ScaleRatio*> asked;
  std::vector<ViewTriplet> triplets;
  for (ScaleRatio& ratio : *ratios) {
    if (ratio.verdict == RatioVerdict::kMeaningful &&
        HasRepeats(scene, ratio.views)) {
      asked.push_back(&ratio);
      triplets.push_back(ratio.views);
    }
  }
  if (asked.empty()) return {};
  const SceneFeatures features(scene);
  LOWLAP_ASSIGN_OR_RETURN(
      const EvidenceKinds prepared,
      PrepareRound(kinds, EvidenceRound::kFirst, features, triplets, context));
  LOWLAP_ASSIGN_OR_RETURN(
      auto unrepeated,
      TestOnce<ScaleRatio>(features, triplets, prepared, 2, context,
                           "scale ratios of what does not repeat", test,
                           TripletContent::kUnrepeated));
  for (std::size_t n = 0; n < asked.size(); ++n) {
    Result<ScaleRatio>& other = unrepeated[n];
    if (!other || other->verdict != RatioVerdict::kMeaningful) {
      asked[n]->verdict = RatioVerdict::kNotMeaningful;
      continue;
    }
    if (!(other->log10_nfa < kMaxLog10Nfa) || !Disagree(*other, *asked[n])) {
      continue;
    }
    other->second_mode = RatioMode{asked[n]->log_ratio, asked[n]->log10_nfa};
    *asked[n] = *std::move(other);
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
