#include "lowlap/averaging/rigidity/internal/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "lowlap/averaging/rigidity/internal/scale_articulations.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

bool Holds(const RigidGroup& group, ViewId view) {
  return std::binary_search(group.views.begin(), group.views.end(), view);
}

std::map<ViewPair, std::size_t> GroupOfEdge(const RigidityReport& report) {
  std::map<ViewPair, std::size_t> group;
  for (std::size_t g = 0; g < report.groups.size(); ++g) {
    for (const ViewPair& edge : report.groups[g].edges) group[edge] = g;
  }
  return group;
}

template <class Predicate>
RigidityReport WithRatios(const ViewGraph& graph,
                          const std::vector<ScaleRatio>& ratios,
                          const Predicate& is_used) {
  std::vector<ViewTriplet> used;
  for (const ScaleRatio& ratio : ratios) {
    if (ratio.verdict == RatioVerdict::kMeaningful && is_used(ratio)) {
      used.push_back(ratio.views);
    }
  }
  return AnalyzeRigidity(graph, used);
}

std::vector<std::size_t> WeakRatiosInUse(const std::vector<ScaleRatio>& ratios,
                                         const DiagnosisOptions& options,
                                         const RigidityReport& strong) {
  const auto group = GroupOfEdge(strong);
  std::vector<std::size_t> weak;
  for (std::size_t r = 0; r < ratios.size(); ++r) {
    const ScaleRatio& ratio = ratios[r];
    const ViewTriplet& views = ratio.views;
    if (ratio.verdict == RatioVerdict::kMeaningful && IsWeak(ratio, options) &&
        group.at(OrderedPair(views.first, views.middle)) !=
            group.at(OrderedPair(views.middle, views.last))) {
      weak.push_back(r);
    }
  }
  SortByEvidence(ratios, &weak);
  return weak;
}

// The view of the group that has the most matches with `view`.
ViewId BestNeighbour(const Scene& scene, const RigidGroup& group, ViewId view) {
  ViewId best = kInvalidId;
  std::size_t most = 0;
  for (const ViewPair& edge : group.edges) {
    if (edge.first != view && edge.second != view) continue;
    const RelativePose& pose = scene.relative_poses.at(edge);
    const std::size_t count =
        pose.point_inliers.size() + pose.line_inliers.size();
    if (best == kInvalidId || count > most) {
      best = edge.first == view ? edge.second : edge.first;
      most = count;
    }
  }
  return best;
}

std::optional<std::size_t> BestRejectedRatio(const Scene& scene,
                                             const RigidGroup& a,
                                             const RigidGroup& b, ViewId view) {
  const std::set<ViewPair> in_a(a.edges.begin(), a.edges.end());
  const std::set<ViewPair> in_b(b.edges.begin(), b.edges.end());
  std::optional<std::size_t> best;
  for (std::size_t r = 0; r < scene.scale_ratios.size(); ++r) {
    const ScaleRatio& ratio = scene.scale_ratios[r];
    if (ratio.views.middle != view ||
        ratio.verdict != RatioVerdict::kNotMeaningful) {
      continue;
    }
    const ViewPair first = OrderedPair(ratio.views.first, view);
    const ViewPair last = OrderedPair(view, ratio.views.last);
    const bool joins = (in_a.count(first) > 0 && in_b.count(last) > 0) ||
                       (in_b.count(first) > 0 && in_a.count(last) > 0);
    if (joins &&
        (!best || ratio.log10_nfa < scene.scale_ratios[*best].log10_nfa)) {
      best = r;
    }
  }
  return best;
}

// The views of two sets whose ids are nearest.
void FindNearest(const std::vector<ViewId>& group,
                 const std::vector<ViewId>& part, FloatingPart* floating) {
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
  for (const ViewId a : group) {
    const auto above = std::lower_bound(part.begin(), part.end(), a);
    const auto consider = [&](ViewId b) {
      const std::uint32_t distance =
          std::max(a, b).value() - std::min(a, b).value();
      if (distance >= least) return;
      least = distance;
      floating->near_group = a;
      floating->near_part = b;
    };
    if (above != part.end()) consider(*above);
    if (above != part.begin()) consider(*std::prev(above));
  }
}

std::vector<FloatingPart> FindFloating(const Scene& scene,
                                       const RigidityReport& report) {
  std::vector<FloatingPart> floating;
  std::map<ViewId, std::size_t> component_of;
  for (std::size_t c = 0; c < report.connected_components.size(); ++c) {
    for (const ViewId view : report.connected_components[c]) {
      component_of[view] = c;
    }
  }
  std::set<std::size_t> known;  // components
  for (std::size_t g = 0; g < report.groups.size(); ++g) {
    const RigidGroup& group = report.groups[g];
    const std::size_t component = component_of.at(group.views.front());
    const bool is_first = known.insert(component).second;
    if (g == 0) continue;
    FloatingPart part;
    if (is_first) {
      part.views = report.connected_components[component];
      FindNearest(report.groups[0].views, part.views, &part);
      floating.push_back(std::move(part));
      continue;
    }
    part.views = group.views;
    // The largest group that it shares a camera with.
    std::size_t meets = report.groups.size();
    for (const ArticulationView& articulation : report.articulation_views) {
      if (!Holds(group, articulation.view)) continue;
      for (const std::size_t other : articulation.groups) {
        if (other == g || other >= meets) continue;
        meets = other;
        part.meets_in = articulation.view;
      }
    }
    const RigidGroup& other = report.groups[meets];
    part.near_group = BestNeighbour(scene, other, part.meets_in);
    part.near_part = BestNeighbour(scene, group, part.meets_in);
    part.rejected_ratio = BestRejectedRatio(scene, other, group, part.meets_in);
    floating.push_back(std::move(part));
  }
  for (const ViewId view : report.isolated_views) {
    FloatingPart part;
    part.views = {view};
    if (!report.groups.empty()) {
      FindNearest(report.groups[0].views, part.views, &part);
    }
    floating.push_back(std::move(part));
  }
  return floating;
}

}  // namespace

Status DiagnosisOptions::Validate() const {
  if (min_inliers < 0 || !(max_stddev > 0) || std::isnan(max_log10_nfa) ||
      min_shared_tracks < 1) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "diagnosis: the least number of inliers must not be "
                     "negative, that of tracks and the largest deviation must "
                     "be positive, and the log10 NFA a number");
  }
  return {};
}

bool Diagnosis::IsFirm() const {
  return by_strong_ratios.groups.size() == 1 &&
         by_strong_ratios.isolated_views.empty();
}

bool IsWeak(const ScaleRatio& ratio, const DiagnosisOptions& options) {
  return ratio.NumInliers() < options.min_inliers || !ratio.HasMajority() ||
         ratio.log10_nfa > options.max_log10_nfa ||
         ratio.log_ratio_stddev > options.max_stddev;
}

TripletPrediction PredictTripletAveraging(const Scene& scene,
                                          int min_shared_tracks) {
  const RigidityReport report =
      AnalyzeTripletRigidity(scene, min_shared_tracks);
  TripletPrediction prediction;
  if (!report.connected_components.empty()) {
    prediction.kept = report.connected_components.front();
  }
  const std::set<ViewId> kept(prediction.kept.begin(), prediction.kept.end());
  for (const auto& entry : scene.views) {
    if (kept.count(entry.first) == 0) prediction.lost.push_back(entry.first);
  }
  std::vector<std::size_t> new_index(report.groups.size());
  for (std::size_t g = 0; g < report.groups.size(); ++g) {
    if (kept.count(report.groups[g].views.front()) == 0) continue;
    new_index[g] = prediction.groups.size();
    prediction.groups.push_back(report.groups[g]);
  }
  for (const ArticulationView& articulation : report.articulation_views) {
    if (kept.count(articulation.view) == 0) continue;
    prediction.articulation_views.push_back(articulation);
    for (std::size_t& g : prediction.articulation_views.back().groups)
      g = new_index[g];
  }
  return prediction;
}

Result<ScaleDiagnosis> DiagnoseScales(const ViewGraph& graph,
                                      const std::vector<ScaleRatio>& ratios,
                                      const DiagnosisOptions& options) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  for (const ScaleRatio& ratio : ratios) {
    const ViewTriplet& v = ratio.views;
    for (const ViewId outer : {v.first, v.last}) {
      if (graph.FindPair(outer, v.middle)) continue;
      return MakeError(ErrorCode::kInvalidScene,
                       "the scale ratio of views " +
                           std::to_string(v.first.value()) + "-" +
                           std::to_string(v.middle.value()) + "-" +
                           std::to_string(v.last.value()) +
                           " is without one of its relative poses");
    }
  }
  ScaleDiagnosis diagnosis;
  diagnosis.by_directions = AnalyzeRigidity(graph);
  diagnosis.by_ratios =
      WithRatios(graph, ratios, [](const ScaleRatio&) { return true; });
  diagnosis.by_strong_ratios = WithRatios(
      graph, ratios, [&](const ScaleRatio& r) { return !IsWeak(r, options); });
  diagnosis.weak_ratios =
      WeakRatiosInUse(ratios, options, diagnosis.by_strong_ratios);
  diagnosis.articulation_views =
      FindScaleArticulations(ratios, diagnosis, options);
  return diagnosis;
}

Result<Diagnosis> Diagnose(const Scene& scene,
                           const DiagnosisOptions& options) {
  auto scales = DiagnoseScales(ViewGraph(scene), scene.scale_ratios, options);
  if (!scales) return tl::unexpected<Error>(scales.error());
  Diagnosis diagnosis{std::move(*scales), {}, {}};
  diagnosis.floating = FindFloating(scene, diagnosis.by_ratios);
  diagnosis.by_triplets =
      PredictTripletAveraging(scene, options.min_shared_tracks);
  return diagnosis;
}

}  // namespace lowlap
