#include "lowlap/pipeline/internal/scene_in_use.h"

#include <algorithm>
#include <set>
#include <utility>

#include "lowlap/averaging/reliability/internal/solution_agreement.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

Result<Scene> SceneInUse(Scene scene, SolveOptions options,
                         const RunContext& context) {
  if (scene.relative_poses.empty()) return scene;
  options.reuse_ratios = !scene.scale_ratios.empty();
  Scene solved = scene;
  LOWLAP_ASSIGN_OR_RETURN(const auto composed,
                          ComposeSolution(&solved, options, context, nullptr));
  LogDecisions(composed.start.motions, solved, context);
  const PoseSummary& summary = composed.poses;
  scene.relative_poses = std::move(solved.relative_poses);
  scene.scale_ratios = std::move(solved.scale_ratios);
  for (const auto* edges : {&summary.outlier_edges, &summary.kept_outliers}) {
    for (const OutlierEdge& edge : *edges) {
      scene.relative_poses.erase(edge.views);
    }
  }
  const std::set<ViewTriplet> rejected(
      summary.agreement->rejected_ratios.begin(),
      summary.agreement->rejected_ratios.end());
  const auto is_out = [&](const ScaleRatio& ratio) {
    const ViewTriplet& v = ratio.views;
    return rejected.count(v) > 0 ||
           scene.FindRelativePose(v.first, v.middle) == nullptr ||
           scene.FindRelativePose(v.middle, v.last) == nullptr;
  };
  scene.scale_ratios.erase(std::remove_if(scene.scale_ratios.begin(),
                                          scene.scale_ratios.end(), is_out),
                           scene.scale_ratios.end());
  return scene;
}

}  // namespace lowlap
