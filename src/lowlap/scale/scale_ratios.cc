#include "lowlap/scale/scale_ratios.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "lowlap/core/parallel.h"
#include "lowlap/scale/planes_by_pair.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scale/triplet_view.h"

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
  if (const Status status = options.Validate(); !status) {
    return tl::unexpected<Error>(status.error());
  }
  const NormalizedFeaturesByView features = NormalizeAllFeatures(scene);
  PlanesByPair planes;
  if (options.use_coplanar && options.use_coplanar_points) {
    Result<PlanesByPair> found =
        FindPlanesByPair(scene, features, triplets, context);
    if (!found) return tl::unexpected<Error>(std::move(found.error()));
    planes = std::move(*found);
  }
  const std::unique_ptr<ScaleEstimator> estimator = MakeScaleEstimator(options);
  std::vector<Result<ScaleRatio>> results(triplets.size());
  const Status status =
      ParallelFor(context, "scale ratios", triplets.size(), [&](std::size_t n) {
        const Result<TripletView> triplet =
            MakeTripletView(scene, features, triplets[n], options, &planes);
        results[n] =
            triplet
                ? estimator->Estimate(*triplet)
                : Result<ScaleRatio>(tl::unexpected<Error>(triplet.error()));
      });
  if (!status) return tl::unexpected<Error>(status.error());
  std::vector<ScaleRatio> ratios;
  ratios.reserve(results.size());
  for (Result<ScaleRatio>& result : results) {
    if (!result) return tl::unexpected<Error>(std::move(result.error()));
    ratios.push_back(std::move(*result));
  }
  return ratios;
}

}  // namespace lowlap
