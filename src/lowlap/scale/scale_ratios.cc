#include "lowlap/scale/scale_ratios.h"

#include <algorithm>
#include <map>

#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scale/triplet_tests.h"

namespace lowlap {

std::vector<ViewTriplet> FindTriplets(const Scene& scene) {
  std::map<ViewId, std::vector<ViewId>> neighbors;
  for (const auto& [views, edge] : scene.relative_poses) {
    neighbors[views.first].push_back(views.second);
    neighbors[views.second].push_back(views.first);
  }
  std::vector<ViewTriplet> triplets;
  for (auto& [middle, ends] : neighbors) {
    std::sort(ends.begin(), ends.end());
    for (std::size_t a = 0; a < ends.size(); ++a) {
      for (std::size_t b = a + 1; b < ends.size(); ++b) {
        triplets.push_back({ends[a], middle, ends[b]});
      }
    }
  }
  std::sort(triplets.begin(), triplets.end());
  return triplets;
}

Result<std::vector<ScaleRatio>> EstimateScaleRatios(const Scene& scene,
                                                    const ScaleOptions& options,
                                                    const RunContext& context) {
  return EstimateScaleRatios(scene, FindTriplets(scene), options, context);
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
