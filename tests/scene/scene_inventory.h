#pragma once

#include <string>
#include <vector>

#include "lowlap/io/scene_content.h"
#include "lowlap/scene/scene.h"

namespace lowlap::testing {

/// One thing of a scene, by what it is and its numbers.
struct SceneItem {
  std::string what;
  std::vector<double> numbers;
};

/// What a scene holds of some kinds of content, whatever the ids are: views are
/// told by their places. Pixels are relative to the principal point where the
/// kinds have cameras without one.
std::vector<SceneItem> InventoryOf(const Scene& scene,
                                   const SceneContents& contents);

}  // namespace lowlap::testing
