#include "lowlap/scale/ratio_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "lowlap/core/parallel.h"
#include "lowlap/scale/planes_by_pair.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scale/scale_ratios.h"

namespace lowlap {
namespace {

std::vector<double> Grid(double low, double high, double mode) {
  constexpr int kEven = 200;
  constexpr double kFinest = 1e-4;
  constexpr double kGrowth = 1.25;
  std::vector<double> grid = {mode};
  for (int n = 0; n <= kEven; ++n) {
    grid.push_back(low + (high - low) * n / kEven);
  }
  for (double offset = kFinest; offset < high - low; offset *= kGrowth) {
    if (mode - offset > low) grid.push_back(mode - offset);
    if (mode + offset < high) grid.push_back(mode + offset);
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return grid;
}

// Beyond the highest node between it and the mode, and lower than that by
// `prominence` in log10 NFA: the best ratio on one side of the mode. `it` and
// `end` lead away from the mode; returns the log ratio of that highest node.
template <class Iterator>
std::optional<double> PassToSecondMode(Iterator it, Iterator end,
                                       double prominence) {
  std::optional<double> pass;
  double highest = -std::numeric_limits<double>::infinity();
  double highest_at = 0;
  double least = std::numeric_limits<double>::infinity();
  for (; it != end; ++it) {
    const double log10_nfa = it->nfa.log10_nfa;
    if (log10_nfa > highest) {
      highest = log10_nfa;
      highest_at = it->log_ratio;
    }
    if (log10_nfa <= highest - prominence && log10_nfa < least) {
      least = log10_nfa;
      pass = highest_at;
    }
  }
  return pass;
}

std::optional<RatioOptimum> SecondMode(const RatioSupport& support,
                                       const RatioNfaCriterion& criterion,
                                       const RatioProfile& profile) {
  const std::vector<RatioOptimum>& nodes = profile.nodes;
  const auto mode =
      std::find_if(nodes.begin(), nodes.end(), [&](const RatioOptimum& node) {
        return node.log_ratio >= profile.mode.log_ratio;
      });
  // Single features that come and go do not make a mode.
  const double prominence =
      std::max(1.0, 0.1 * std::abs(profile.mode.nfa.log10_nfa));
  std::optional<RatioOptimum> second;
  const auto consider = [&](double low, double high) {
    const RatioOptimum optimum = SweepRatios(support, criterion, low, high);
    if (!second || optimum.nfa.BetterThan(second->nfa)) second = optimum;
  };
  if (const auto pass = PassToSecondMode(mode, nodes.end(), prominence)) {
    consider(*pass, nodes.back().log_ratio);
  }
  if (const auto pass = PassToSecondMode(
          std::make_reverse_iterator(mode == nodes.end() ? mode : mode + 1),
          nodes.rend(), prominence)) {
    consider(nodes.front().log_ratio, *pass);
  }
  return second;
}

Result<std::vector<RatioProfile>> ProfileOnce(
    const Scene& scene, const NormalizedFeaturesByView& features,
    const std::vector<ViewTriplet>& triplets, const ScaleOptions& options,
    const PlanesByPair& planes, const RunContext& context) {
  std::vector<Result<RatioProfile>> results(triplets.size());
  const Status status = ParallelFor(
      context, "ratio profiles", triplets.size(), [&](std::size_t n) {
        const Result<TripletView> triplet =
            MakeTripletView(scene, features, triplets[n], options, &planes);
        results[n] =
            triplet
                ? ProfileRatio(*triplet, options)
                : Result<RatioProfile>(tl::unexpected<Error>(triplet.error()));
      });
  if (!status) return tl::unexpected<Error>(status.error());
  std::vector<RatioProfile> profiles;
  for (Result<RatioProfile>& result : results) {
    if (!result) return tl::unexpected<Error>(std::move(result.error()));
    profiles.push_back(std::move(*result));
  }
  return profiles;
}

void PayForSecondTest(RatioProfile* profile) {
  const auto pay = [](RatioOptimum* optimum) {
    optimum->nfa.log10_nfa += std::log10(2.0);
  };
  PayForSecondTest(&profile->ratio);
  pay(&profile->mode);
  if (profile->second_mode) pay(&*profile->second_mode);
  for (RatioOptimum& node : profile->nodes) pay(&node);
}

}  // namespace

Result<RatioProfile> ProfileRatio(const TripletView& triplet,
                                  const ScaleOptions& given) {
  ScaleOptions options = given;
  options.criterion = ScaleCriterion::kAContrario;
  options.nfa_form = NfaForm::kCalibrated;
  options.search = RatioSearch::kSweep;
  const Result<ScaleRatio> ratio =
      MakeScaleEstimator(options)->Estimate(triplet);
  if (!ratio) return tl::unexpected<Error>(ratio.error());
  RatioProfile profile;
  profile.ratio = *ratio;
  const RatioSupport support(triplet, options);
  if (support.hypotheses().empty()) return profile;

  const RatioNfaCriterion criterion(support, triplet, options);
  profile.mode = SweepRatios(support, criterion);
  SupportWorkspace workspace;
  for (const double log_ratio :
       Grid(support.hypotheses().front().log_ratio,
            support.hypotheses().back().log_ratio, profile.mode.log_ratio)) {
    profile.nodes.push_back(
        {log_ratio, criterion.EvaluateAt(
                        log_ratio, support.Count(log_ratio, &workspace))});
  }
  profile.second_mode = SecondMode(support, criterion, profile);
  return profile;
}

Result<std::vector<RatioProfile>> ProfileScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context) {
  if (const Status status = options.Validate(); !status) {
    return tl::unexpected<Error>(status.error());
  }
  const NormalizedFeaturesByView features = NormalizeAllFeatures(scene);
  ScaleOptions of_features = options;
  of_features.use_coplanar_points = false;
  auto profiles =
      ProfileOnce(scene, features, triplets, of_features, {}, context);
  if (!profiles || !options.use_coplanar || !options.use_coplanar_points) {
    return profiles;
  }
  std::vector<std::size_t> undecided;
  std::vector<ViewTriplet> undecided_triplets;
  for (std::size_t n = 0; n < triplets.size(); ++n) {
    if ((*profiles)[n].ratio.verdict == RatioVerdict::kMeaningful) continue;
    undecided.push_back(n);
    undecided_triplets.push_back(triplets[n]);
  }
  if (undecided.empty()) return profiles;
  const auto planes =
      FindPlanesByPair(scene, features, undecided_triplets, context);
  if (!planes) return tl::unexpected<Error>(planes.error());
  auto with_planes = ProfileOnce(scene, features, undecided_triplets, options,
                                 *planes, context);
  if (!with_planes) return with_planes;
  for (std::size_t n = 0; n < undecided.size(); ++n) {
    RatioProfile& profile = (*with_planes)[n];
    if (!profile.nodes.empty()) PayForSecondTest(&profile);
    (*profiles)[undecided[n]] = std::move(profile);
  }
  return profiles;
}

}  // namespace lowlap
