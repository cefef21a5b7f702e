#include "lowlap/scale/scale_ratios.h"

#include "lowlap/scale/internal/triplet_rounds.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

Result<std::vector<ScaleRatio>> EstimateScaleRatios(const Scene& scene,
                                                    const ScaleOptions& options,
                                                    const RunContext& context) {
  return EstimateScaleRatios(scene, FindTriplets(ViewGraph(scene)), options,
                             context);
}

Result<std::vector<ScaleRatio>> EstimateScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context) {
  return TestTriplets<ScaleRatio>(
      scene, triplets, options, context, "scale ratios",
      [](const TripletView& triplet, const ScaleOptions& of_test) {
        return MakeScaleEstimator(of_test)->Estimate(triplet);
      });
}

}  // namespace lowlap
