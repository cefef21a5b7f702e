#include "lowlap/scale/scale_ratios.h"

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scale/internal/triplet_rounds.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

Result<std::vector<ScaleRatio>> EstimateScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleEstimator& estimator, const RunContext& context) {
  return TestTriplets<ScaleRatio>(
      scene, triplets, estimator.kinds(), context, "scale ratios",
      [&](const TripletView& triplet, const TripletEvidence& evidence) {
        return estimator.Estimate(triplet, evidence);
      });
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
