#pragma once

#include <string>
#include <vector>

#include "lowlap/core/internal/joined.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The image names of views, separated by commas.
inline std::string NamesOf(const Scene& scene,
                           const std::vector<ViewId>& views) {
  return Joined(views, ", ", [&](ViewId view) { return scene.NameOf(view); });
}

}  // namespace lowlap
