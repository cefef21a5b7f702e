#include "lowlap/scale/internal/search/ratio_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "lowlap/scale/internal/triplet_rounds.h"
#include "lowlap/scale/scale_estimator.h"

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

}  // namespace

Result<RatioProfile> ProfileRatio(const TripletView& triplet,
                                  const TripletEvidence& evidence) {
  const Result<ScaleRatio> ratio =
      AContrarioScaleEstimator({}).Estimate(triplet, evidence);
  if (!ratio) return tl::unexpected<Error>(ratio.error());
  RatioProfile profile;
  profile.ratio = *ratio;
  const RatioSupport support(evidence);
  if (support.hypotheses().empty()) return profile;

  for (int k = 0; k < support.num_kinds(); ++k) {
    profile.kinds.push_back(evidence.kinds[support.PlaceOf(k)].name);
  }
  const RatioNfaCriterion criterion(support, triplet, NfaForm::kCalibrated);
  profile.mode = SweepRatios(support, criterion);
  SupportWorkspace workspace;
  for (const double log_ratio :
       Grid(support.hypotheses().front().log_ratio,
            support.hypotheses().back().log_ratio, profile.mode.log_ratio)) {
    profile.nodes.push_back(
        {log_ratio,
         criterion.Evaluate(log_ratio, support.Count(log_ratio, &workspace))});
  }
  profile.second_mode = SecondMode(support, criterion, profile);
  // The ratio has paid for its tests.
  const auto pay = [&](RatioOptimum* optimum) {
    optimum->nfa.log10_nfa +=
        std::log10(static_cast<double>(evidence.num_tests));
  };
  pay(&profile.mode);
  if (profile.second_mode) pay(&*profile.second_mode);
  for (RatioOptimum& node : profile.nodes) pay(&node);
  return profile;
}

Result<std::vector<RatioProfile>> ProfileScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const EvidenceKinds& kinds, const RunContext& context) {
  return TestTriplets<RatioProfile>(scene, triplets, kinds, context,
                                    "ratio profiles", ProfileRatio);
}

}  // namespace lowlap
