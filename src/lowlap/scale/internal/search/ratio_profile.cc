#include "lowlap/scale/internal/search/ratio_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "lowlap/scale/internal/triplet_rounds.h"
#include "lowlap/scale/scale_estimator.h"

namespace lowlap {
namespace {

// How close the nodes of a profile are.
struct GridSpacing {
  int num_even;
  double finest;  // distance from the mode of the node next to it
  double growth;  // of this distance, to the node after that
};
constexpr GridSpacing kProfileGrid = {200, 1e-4, 1.25};
constexpr GridSpacing kSketchGrid = {48, 1e-3, 1.6};

std::vector<double> Grid(double low, double high, double mode,
                         const GridSpacing& spacing) {
  std::vector<double> grid = {mode};
  for (int n = 0; n <= spacing.num_even; ++n) {
    grid.push_back(low + (high - low) * n / spacing.num_even);
  }
  for (double offset = spacing.finest; offset < high - low;
       offset *= spacing.growth) {
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

// The NFA has paid for the tests of the triplet.
void PayForTests(const TripletEvidence& evidence, RatioOptimum* optimum) {
  optimum->nfa.log10_nfa += std::log10(static_cast<double>(evidence.num_tests));
}

std::vector<std::string> NamesOf(const RatioSupport& support,
                                 const TripletEvidence& evidence) {
  std::vector<std::string> names;
  names.reserve(support.num_kinds());
  for (int k = 0; k < support.num_kinds(); ++k) {
    names.push_back(evidence.kinds[support.PlaceOf(k)].name);
  }
  return names;
}

// On a grid about `mode`, before tests are paid for.
std::vector<RatioOptimum> EvaluateNodes(const RatioSupport& support,
                                        const RatioNfaCriterion& criterion,
                                        double mode,
                                        const GridSpacing& spacing) {
  std::vector<RatioOptimum> nodes;
  SupportWorkspace workspace;
  for (const double log_ratio :
       Grid(support.hypotheses().front().log_ratio,
            support.hypotheses().back().log_ratio, mode, spacing)) {
    nodes.push_back(
        {log_ratio,
         criterion.Evaluate(log_ratio, support.Count(log_ratio, &workspace))});
  }
  return nodes;
}

// Whether the ratio was estimated from no more than this.
bool HoldsAllOf(const TripletEvidence& evidence, const ScaleRatio& ratio) {
  return std::all_of(
      ratio.kinds.begin(), ratio.kinds.end(), [&](const KindSupport& kind) {
        return std::any_of(
            evidence.kinds.begin(), evidence.kinds.end(),
            [&](const auto& asked) { return asked.name == kind.kind; });
      });
}

RatioProfile SketchRatio(const TripletView& triplet,
                         const TripletEvidence& evidence,
                         const ScaleRatio& ratio) {
  RatioProfile sketch;
  if (!HoldsAllOf(evidence, ratio)) {
    sketch.ratio.verdict = RatioVerdict::kNotMeaningful;  // ask the other kinds
    return sketch;
  }
  sketch.ratio = ratio;
  const RatioSupport support(evidence);
  if (support.hypotheses().empty()) return sketch;
  sketch.kinds = NamesOf(support, evidence);
  const RatioNfaCriterion criterion(support, triplet, NfaForm::kCalibrated);
  sketch.nodes =
      EvaluateNodes(support, criterion, ratio.log_ratio, kSketchGrid);
  for (RatioOptimum& node : sketch.nodes) PayForTests(evidence, &node);
  return sketch;
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

  profile.kinds = NamesOf(support, evidence);
  const RatioNfaCriterion criterion(support, triplet, NfaForm::kCalibrated);
  profile.mode = SweepRatios(support, criterion);
  profile.nodes =
      EvaluateNodes(support, criterion, profile.mode.log_ratio, kProfileGrid);
  profile.second_mode = SecondMode(support, criterion, profile);
  // The ratio has paid for them.
  PayForTests(evidence, &profile.mode);
  if (profile.second_mode) PayForTests(evidence, &*profile.second_mode);
  for (RatioOptimum& node : profile.nodes) PayForTests(evidence, &node);
  return profile;
}

Result<std::vector<RatioProfile>> ProfileScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const EvidenceKinds& kinds, const RunContext& context) {
  return TestTriplets<RatioProfile>(scene, triplets, kinds, context,
                                    "ratio profiles", ProfileRatio);
}

Result<std::vector<RatioProfile>> SketchScaleRatios(
    const Scene& scene, const std::vector<ScaleRatio>& ratios,
    const EvidenceKinds& kinds, const RunContext& context) {
  std::vector<ViewTriplet> triplets;
  std::map<ViewTriplet, const ScaleRatio*> ratio_of;
  for (const ScaleRatio& ratio : ratios) {
    triplets.push_back(ratio.views);
    ratio_of[ratio.views] = &ratio;
  }
  const auto sketch = [&](const TripletView& triplet,
                          const TripletEvidence& evidence) {
    return Result<RatioProfile>(
        SketchRatio(triplet, evidence, *ratio_of.at(triplet.views)));
  };
  return TestTriplets<RatioProfile>(scene, triplets, kinds, context,
                                    "ratio profiles", sketch);
}

}  // namespace lowlap
