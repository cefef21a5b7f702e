#pragma once

#include <set>

#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A scene as what does not repeat in its photographs shows it.
struct UnrepeatedScene {
  /// Without the inlier matches, of points and of lines, of which a side
  /// repeats (ViewFeatures::repeated_points).
  Scene scene;
  /// The relative poses that lost matches.
  std::set<ViewPair> changed;
};

/// Linear in the size of the scene.
UnrepeatedScene WithoutRepeatedMatches(const Scene& scene);

}  // namespace lowlap
