#include <algorithm>
#include <cmath>

#include "lowlap/scene/view_graph.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

std::optional<double> SyntheticScene::TrueLogRatio(
    const ViewTriplet& triplet) const {
  const auto baseline = [&](ViewId a, ViewId b) {
    const auto found = true_baselines.find({std::min(a, b), std::max(a, b)});
    return found == true_baselines.end() ? 0.0 : found->second;
  };
  const double reference = baseline(triplet.first, triplet.middle);
  const double target = baseline(triplet.middle, triplet.last);
  if (!(reference > 0) || !(target > 0)) return std::nullopt;
  return std::log(target / reference);
}

Scene TrueSolution(const SyntheticScene& synthetic) {
  Scene scene = synthetic.scene;
  for (const auto& [view, pose] : synthetic.true_poses) {
    scene.poses[scene.views.at(view).pose_id] = pose;
  }
  for (const ViewTriplet& triplet : FindTriplets(ViewGraph(scene))) {
    const std::optional<double> log_ratio = synthetic.TrueLogRatio(triplet);
    if (!log_ratio) continue;
    ScaleRatio ratio;
    ratio.views = triplet;
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log_ratio = *log_ratio;
    scene.scale_ratios.push_back(ratio);
  }
  for (const auto& [id, position] : synthetic.true_points) {
    Landmark landmark;
    landmark.position = position;
    for (const FeatureRef& ref : scene.point_tracks.at(id)) {
      landmark.observations.push_back(
          {ref.view, ref.feature,
           scene.features.at(ref.view).points_px[ref.feature]});
    }
    scene.structure[id] = landmark;
  }
  for (const auto& [id, line] : synthetic.true_lines) {
    LineLandmark landmark;
    landmark.line = PluckerLine::FromPoints(line.start, line.end);
    landmark.start = line.start;
    landmark.end = line.end;
    landmark.observations = scene.line_tracks.at(id);
    scene.line_structure[id] = landmark;
  }
  return scene;
}

}  // namespace lowlap
