#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/pipeline/internal/scene_reduction.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

/// Triplets that are looked at for one pair.
constexpr std::size_t kMaxTriplets = 8;
/// Ratios of two motions differ clearly by ten decimal digits of chance, and by
/// more than the features by which two fits differ anyway.
constexpr double kDecisiveDigits = 10;
constexpr double kDecisiveShare = 0.1;

std::array<ViewPair, 2> EdgesOf(const ViewTriplet& views) {
  return {OrderedPair(views.first, views.middle),
          OrderedPair(views.middle, views.last)};
}

// The triplets through each pair that has alternatives.
std::map<ViewPair, std::vector<ViewTriplet>> TripletsToAsk(const Scene& scene) {
  std::map<ViewPair, std::vector<ViewTriplet>> triplets;
  for (const ViewTriplet& views : FindTriplets(ViewGraph(scene))) {
    for (const ViewPair& edge : EdgesOf(views)) {
      if (!scene.relative_poses.at(edge).alternatives.empty()) {
        triplets[edge].push_back(views);
      }
    }
  }
  for (auto& [pair, list] : triplets) {
    const auto evidence = [&scene, pair = pair](const ViewTriplet& views) {
      const auto edges = EdgesOf(views);
      return scene.relative_poses.at(edges[edges[0] == pair ? 1 : 0]).log10_nfa;
    };
    std::stable_sort(list.begin(), list.end(),
                     [&](const ViewTriplet& a, const ViewTriplet& b) {
                       return evidence(a) < evidence(b);
                     });
    if (list.size() > kMaxTriplets) list.resize(kMaxTriplets);
  }
  return triplets;
}

// One triplet under one motion of each of its two edges.
struct Trial {
  ViewTriplet views;
  std::array<std::size_t, 2> motions = {0, 0};  // of EdgesOf(views)
};

// log10 NFA of the trial's ratio; 0 if there is none.
Result<double> CostOf(const Scene& scene, const Trial& trial,
                      const ScaleEstimator& estimator) {
  RunContext serial;
  serial.num_threads = 1;
  const auto edges = EdgesOf(trial.views);
  const auto ratios = EstimateScaleRatios(
      SceneOfPairs(
          scene, {{edges[0], trial.motions[0]}, {edges[1], trial.motions[1]}}),
      {trial.views}, estimator, serial);
  if (!ratios) return tl::unexpected<Error>(ratios.error());
  const ScaleRatio& ratio = ratios->front();
  if (ratio.verdict != RatioVerdict::kMeaningful) return 0.0;
  return std::min(ratio.log10_nfa, 0.0);
}

}  // namespace

Result<std::vector<HypothesisDecision>> DecideHypothesesByTriplets(
    Scene* scene, const ScaleEstimator& estimator, const RunContext& context) {
  const auto triplets = TripletsToAsk(*scene);
  std::set<ViewTriplet> distinct;
  for (const auto& entry : triplets) {
    distinct.insert(entry.second.begin(), entry.second.end());
  }
  std::vector<Trial> trials;
  for (const ViewTriplet& views : distinct) {
    const auto edges = EdgesOf(views);
    for (std::size_t a = 0;
         a < NumHypotheses(scene->relative_poses.at(edges[0])); ++a) {
      for (std::size_t b = 0;
           b < NumHypotheses(scene->relative_poses.at(edges[1])); ++b) {
        trials.push_back({views, {a, b}});
      }
    }
  }
  std::vector<Result<double>> costs(trials.size());
  const Status done = ParallelFor(
      context, "ambiguous planes", trials.size(),
      [&](std::size_t n) { costs[n] = CostOf(*scene, trials[n], estimator); });
  if (!done) return tl::unexpected<Error>(done.error());

  // Least cost of every triplet under each motion of each of its edges.
  std::map<std::pair<ViewTriplet, ViewPair>, std::vector<double>> least;
  for (std::size_t n = 0; n < trials.size(); ++n) {
    if (!costs[n]) return tl::unexpected<Error>(costs[n].error());
    const auto edges = EdgesOf(trials[n].views);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      auto& of_edge = least[{trials[n].views, edges[e]}];
      of_edge.resize(NumHypotheses(scene->relative_poses.at(edges[e])), 0.0);
      double& cost = of_edge[trials[n].motions[e]];
      cost = std::min(cost, *costs[n]);
    }
  }
  std::vector<HypothesisDecision> decisions;
  for (const auto& [pair, asked] : triplets) {
    RelativePose& pose = scene->relative_poses.at(pair);
    std::vector<double> total(NumHypotheses(pose), 0.0);
    for (const ViewTriplet& views : asked) {
      const std::vector<double>& of_edge = least.at({views, pair});
      for (std::size_t n = 0; n < total.size(); ++n) total[n] += of_edge[n];
    }
    const double best = *std::min_element(total.begin(), total.end());
    const double margin = std::max(kDecisiveDigits, -kDecisiveShare * best);
    const HypothesisDecision decision =
        ChooseHypothesis(total, margin, HypothesisGrounds::kTriplets, &pose);
    if (decision.grounds != HypothesisGrounds::kNone)
      decisions.push_back(decision);
  }
  return decisions;
}

Result<std::vector<HypothesisDecision>> DecideHypotheses(
    Scene* scene, const ScaleEstimator& scale, const PoseOptions& poses,
    const RunContext& context) {
  std::map<ViewPair, HypothesisDecision> decisions;
  for (const auto& [views, pose] : scene->relative_poses) {
    if (!pose.alternatives.empty()) decisions[views].views = views;
  }
  std::size_t num_decided = 0;
  for (bool changed = true; changed && num_decided < decisions.size();) {
    changed = false;
    for (const bool by_cycles : {true, false}) {
      const auto decided =
          by_cycles ? DecideHypothesesByCycles(scene, poses, context)
                    : DecideHypothesesByTriplets(scene, scale, context);
      if (!decided) return tl::unexpected<Error>(decided.error());
      for (const HypothesisDecision& decision : *decided) {
        decisions.at(decision.views) = decision;
      }
      num_decided += decided->size();
      changed = !decided->empty();
    }
  }
  std::vector<HypothesisDecision> result;
  result.reserve(decisions.size());
  for (const auto& entry : decisions) result.push_back(entry.second);
  return result;
}

void LogDecisions(const std::vector<HypothesisDecision>& decisions,
                  const Scene& scene, const RunContext& context) {
  for (const HypothesisDecision& decision : decisions) {
    const std::string pair = scene.NameOf(decision.views.first) + " and " +
                             scene.NameOf(decision.views.second) +
                             " share one plane, which two motions explain; ";
    if (decision.grounds == HypothesisGrounds::kNone) {
      context.Log(LogLevel::kWarning, pair + "nothing else tells them apart");
    } else {
      context.Log(LogLevel::kInfo,
                  pair + "decided by " +
                      HypothesisGroundsName(decision.grounds) +
                      (decision.replaced ? ": the second" : ": the first"));
    }
  }
}

}  // namespace lowlap
