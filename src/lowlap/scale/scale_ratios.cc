#include "lowlap/scale/scale_ratios.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "lowlap/core/parallel.h"
#include "lowlap/scale/planes_by_pair.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {
namespace {

// Triplets with many matches first, so that no thread is left with a large one
// at the end.
std::vector<std::size_t> LargestFirst(
    const Scene& scene, const std::vector<ViewTriplet>& triplets) {
  const auto num_matches = [&](ViewId a, ViewId b) -> std::size_t {
    const RelativePose* edge = scene.FindRelativePose(a, b);
    if (edge == nullptr) return 0;
    return edge->point_inliers.size() + edge->line_inliers.size();
  };
  std::vector<std::size_t> size;
  for (const ViewTriplet& views : triplets) {
    size.push_back(num_matches(views.first, views.middle) +
                   num_matches(views.middle, views.last));
  }
  std::vector<std::size_t> order(triplets.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(
      order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
  return order;
}

bool HasFeatures(const NormalizedFeaturesByView& features,
                 const ViewTriplet& views) {
  return features.count(views.first) > 0 && features.count(views.middle) > 0 &&
         features.count(views.last) > 0;
}

Result<std::vector<ScaleRatio>> EstimateOnce(
    const Scene& scene, const NormalizedFeaturesByView& features,
    const std::vector<ViewTriplet>& triplets, const ScaleOptions& options,
    const PlanesByPair& planes, const RunContext& context) {
  const std::unique_ptr<ScaleEstimator> estimator = MakeScaleEstimator(options);
  const std::vector<std::size_t> order = LargestFirst(scene, triplets);
  std::vector<Result<ScaleRatio>> results(triplets.size());
  const Status status =
      ParallelFor(context, "scale ratios", triplets.size(), [&](std::size_t n) {
        if (!HasFeatures(features, triplets[order[n]])) {
          ScaleRatio nothing;
          nothing.views = triplets[order[n]];
          nothing.verdict = RatioVerdict::kNoCandidates;
          results[order[n]] = std::move(nothing);
          return;
        }
        const Result<TripletView> triplet = MakeTripletView(
            scene, features, triplets[order[n]], options, &planes);
        results[order[n]] =
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

}  // namespace

void PayForSecondTest(ScaleRatio* ratio) {
  if (ratio->verdict == RatioVerdict::kNoCandidates) return;
  ratio->log10_nfa += std::log10(2.0);
  if (ratio->second_mode) ratio->second_mode->log10_nfa += std::log10(2.0);
  if (!(ratio->log10_nfa < 0)) ratio->verdict = RatioVerdict::kNotMeaningful;
}

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
  ScaleOptions of_features = options;
  of_features.use_coplanar_points = false;
  auto ratios =
      EstimateOnce(scene, features, triplets, of_features, {}, context);
  if (!ratios || !options.use_coplanar || !options.use_coplanar_points) {
    return ratios;
  }
  std::vector<std::size_t> undecided;
  std::vector<ViewTriplet> undecided_triplets;
  for (std::size_t n = 0; n < triplets.size(); ++n) {
    if ((*ratios)[n].verdict == RatioVerdict::kMeaningful ||
        !HasFeatures(features, triplets[n])) {
      continue;
    }
    undecided.push_back(n);
    undecided_triplets.push_back(triplets[n]);
  }
  if (undecided.empty()) return ratios;
  const auto planes =
      FindPlanesByPair(scene, features, undecided_triplets, context);
  if (!planes) return tl::unexpected<Error>(planes.error());
  auto with_planes = EstimateOnce(scene, features, undecided_triplets, options,
                                  *planes, context);
  if (!with_planes) return with_planes;
  for (std::size_t n = 0; n < undecided.size(); ++n) {
    ScaleRatio& ratio = (*with_planes)[n];
    if (options.criterion == ScaleCriterion::kAContrario) {
      PayForSecondTest(&ratio);
    }
    (*ratios)[undecided[n]] = std::move(ratio);
  }
  return ratios;
}

}  // namespace lowlap
