#include "lowlap/scale/internal/unrepeated_scene.h"

#include <algorithm>
#include <vector>

namespace lowlap {
namespace {

using Repeated = std::vector<FeatureIndex> ViewFeatures::*;

bool Repeats(const Scene& scene, ViewId view, FeatureIndex feature,
             Repeated repeated) {
  const auto found = scene.features.find(view);
  return found != scene.features.end() &&
         std::binary_search((found->second.*repeated).begin(),
                            (found->second.*repeated).end(), feature);
}

// Whether there were any.
bool EraseRepeated(const Scene& scene, const ViewPair& views, Repeated repeated,
                   std::vector<FeatureMatch>* matches) {
  const auto end = std::remove_if(
      matches->begin(), matches->end(), [&](const FeatureMatch& match) {
        return Repeats(scene, views.first, match.first, repeated) ||
               Repeats(scene, views.second, match.second, repeated);
      });
  const bool has_repeated = end != matches->end();
  matches->erase(end, matches->end());
  return has_repeated;
}

}  // namespace

UnrepeatedScene WithoutRepeatedMatches(const Scene& scene) {
  UnrepeatedScene unrepeated = {scene, {}};
  for (auto& [views, pose] : unrepeated.scene.relative_poses) {
    const bool points = EraseRepeated(
        scene, views, &ViewFeatures::repeated_points, &pose.point_inliers);
    const bool lines = EraseRepeated(
        scene, views, &ViewFeatures::repeated_segments, &pose.line_inliers);
    if (points || lines) unrepeated.changed.insert(views);
  }
  return unrepeated;
}

}  // namespace lowlap
