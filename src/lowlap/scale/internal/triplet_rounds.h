#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "lowlap/core/parallel.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/internal/planes/planes_by_pair.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The order that leaves no thread with a large triplet at the end: many
/// matches first.
std::vector<std::size_t> LargestFirst(const Scene& scene,
                                      const std::vector<ViewTriplet>& triplets);

/// False if a view of the triplet has no intrinsic or no features.
bool HasFeatures(const NormalizedFeaturesByView& features,
                 const ViewTriplet& views);

/// Adds what a second test costs, log10 2: two tests find twice as many false
/// ratios.
void PayForSecondTest(ScaleRatio* ratio);

/// The ratio of an outcome of a test; see also RatioProfile.
inline ScaleRatio& RatioOf(ScaleRatio& ratio) { return ratio; }

/// `test` of every triplet, in parallel: Result<Outcome>(TripletView,
/// ScaleOptions). Triplets without features have no candidates.
/// Errors: those of MakeTripletView and of the test, kCancelled.
template <class Outcome, class Test>
Result<std::vector<Outcome>> TestOnce(const Scene& scene,
                                      const NormalizedFeaturesByView& features,
                                      const std::vector<ViewTriplet>& triplets,
                                      const ScaleOptions& options,
                                      const PlanesByPair& planes,
                                      const RunContext& context,
                                      const char* stage, const Test& test) {
  const std::vector<std::size_t> order = LargestFirst(scene, triplets);
  std::vector<Result<Outcome>> results(triplets.size());
  const Status status =
      ParallelFor(context, stage, triplets.size(), [&](std::size_t n) {
        const ViewTriplet& views = triplets[order[n]];
        Result<Outcome>& result = results[order[n]];
        if (!HasFeatures(features, views)) {
          Outcome nothing;
          RatioOf(nothing).views = views;
          RatioOf(nothing).verdict = RatioVerdict::kNoCandidates;
          result = std::move(nothing);
          return;
        }
        const Result<TripletView> triplet =
            MakeTripletView(scene, features, views, options, &planes);
        result = triplet
                     ? test(*triplet, options)
                     : Result<Outcome>(tl::unexpected<Error>(triplet.error()));
      });
  if (!status) return tl::unexpected<Error>(status.error());
  std::vector<Outcome> outcomes;
  outcomes.reserve(results.size());
  for (Result<Outcome>& result : results) {
    if (!result) return tl::unexpected<Error>(std::move(result.error()));
    outcomes.push_back(std::move(*result));
  }
  return outcomes;
}

/// The same; triplets that are not meaningful by points, lines and pairs are
/// tested a second time, with points and lines on planes
/// (ScaleOptions::use_coplanar_points), and pay for it, if there can be any
/// (PairsOverlap). Outcomes are those of
/// the last test of each, in the order of the triplets.
/// Errors: invalid options too.
template <class Outcome, class Test>
Result<std::vector<Outcome>> TestTriplets(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context, const char* stage,
    const Test& test) {
  if (const Status status = options.Validate(); !status) {
    return tl::unexpected<Error>(status.error());
  }
  const NormalizedFeaturesByView features = NormalizeAllFeatures(scene);
  ScaleOptions of_features = options;
  of_features.use_coplanar_points = false;
  auto outcomes = TestOnce<Outcome>(scene, features, triplets, of_features, {},
                                    context, stage, test);
  if (!outcomes || !options.use_coplanar || !options.use_coplanar_points) {
    return outcomes;
  }
  std::vector<std::size_t> undecided;
  std::vector<ViewTriplet> undecided_triplets;
  for (std::size_t n = 0; n < triplets.size(); ++n) {
    if (RatioOf((*outcomes)[n]).verdict == RatioVerdict::kMeaningful ||
        !HasFeatures(features, triplets[n]) ||
        !PairsOverlap(scene, features, triplets[n])) {
      continue;
    }
    undecided.push_back(n);
    undecided_triplets.push_back(triplets[n]);
  }
  if (undecided.empty()) return outcomes;
  const auto planes =
      FindPlanesByPair(scene, features, undecided_triplets, context);
  if (!planes) return tl::unexpected<Error>(planes.error());
  auto again = TestOnce<Outcome>(scene, features, undecided_triplets, options,
                                 *planes, context, stage, test);
  if (!again) return again;
  for (std::size_t n = 0; n < undecided.size(); ++n) {
    Outcome& outcome = (*again)[n];
    if (options.criterion == ScaleCriterion::kAContrario) {
      PayForSecondTest(&outcome);
    }
    (*outcomes)[undecided[n]] = std::move(outcome);
  }
  return outcomes;
}

}  // namespace lowlap
