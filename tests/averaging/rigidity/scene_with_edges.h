#pragma once

#include <cstdint>
#include <vector>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// Views 0 to 4: triangles 0-1-2 and 2-3-4.
inline const std::vector<ViewPair> kTwoTriangles = {{0, 1}, {0, 2}, {1, 2},
                                                    {2, 3}, {2, 4}, {3, 4}};

/// Views without photographs, and relative poses without a motion.
inline Scene SceneWithEdges(std::uint32_t num_views,
                            const std::vector<ViewPair>& edges) {
  Scene scene;
  for (std::uint32_t view = 0; view < num_views; ++view) {
    scene.views[view] = View();
  }
  for (const ViewPair& edge : edges) scene.relative_poses[edge].views = edge;
  return scene;
}

}  // namespace lowlap
