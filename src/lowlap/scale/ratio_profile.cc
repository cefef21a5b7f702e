#include "lowlap/scale/ratio_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "lowlap/core/parallel.h"
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

// 1 / variance of the inliers by kind; what pairs say of one line is shared by
// the pairs of that line.
std::array<double, kFeatureKinds.size()> Information(
    const RatioSupport& support, const RatioNfa& nfa, double log_ratio) {
  const std::array<const NfaTerm*, kFeatureKinds.size()> terms = {
      &nfa.points, &nfa.lines, &nfa.coplanar, &nfa.plane_points};
  std::array<double, kFeatureKinds.size()> information{};
  std::vector<float> errors_px;
  double sum = 0;
  for (const FeatureKind kind : kFeatureKinds) {
    const std::size_t k = static_cast<std::size_t>(kind);
    if (!(terms[k]->log10_nfa < 0)) continue;
    const bool is_pair = kind == FeatureKind::kCoplanar;
    const std::size_t count = is_pair
                                  ? support.Tier(nfa.coplanar_tier).num_pairs
                                  : support.Ratios(kind).size();
    support.Errors(kind, log_ratio, &errors_px);
    const auto is_inlier = [&](std::size_t n) {
      return errors_px[n] < LadderThresholdPx(terms[k]->step);
    };
    std::vector<int> of_first(is_pair ? count : 0, 0);
    std::vector<int> of_last(is_pair ? count : 0, 0);
    for (std::size_t n = 0; is_pair && n < count; ++n) {
      of_first[support.FirstLineOf(static_cast<int>(n))] += is_inlier(n);
      of_last[support.LastLineOf(static_cast<int>(n))] += is_inlier(n);
    }
    for (std::size_t n = 0; n < count; ++n) {
      if (!is_inlier(n)) continue;
      const double stddev = support.Ratios(kind)[n].log_ratio_stddev;
      const int index = static_cast<int>(n);
      const double multiplicity =
          is_pair ? 0.5 * (of_first[support.FirstLineOf(index)] +
                           of_last[support.LastLineOf(index)])
                  : 1.0;
      information[k] += 1.0 / (stddev * stddev * multiplicity);
    }
    sum += information[k];
  }
  if (sum > 0) {
    for (double& share : information) share /= sum;
  }
  return information;
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
  profile.views = triplet.views;
  profile.log_ratio = ratio->log_ratio;
  const double reach = 1.96 * ratio->log_ratio_stddev;
  profile.interval_low = profile.log_ratio - reach;
  profile.interval_high = profile.log_ratio + reach;
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
  profile.information_share =
      Information(support, profile.mode.nfa, profile.log_ratio);
  return profile;
}

Result<std::vector<RatioProfile>> ProfileScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context) {
  if (const Status status = options.Validate(); !status) {
    return tl::unexpected<Error>(status.error());
  }
  ScaleOptions of_features = options;
  of_features.use_coplanar_points = false;
  const NormalizedFeaturesByView features = NormalizeAllFeatures(scene);
  std::vector<Result<RatioProfile>> results(triplets.size());
  const Status status = ParallelFor(
      context, "ratio profiles", triplets.size(), [&](std::size_t n) {
        const Result<TripletView> triplet =
            MakeTripletView(scene, features, triplets[n], of_features);
        results[n] =
            triplet
                ? ProfileRatio(*triplet, of_features)
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

}  // namespace lowlap
