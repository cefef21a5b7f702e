#pragma once

#include <string>
#include <vector>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// The image names of views, separated by commas.
inline std::string NamesOf(const Scene& scene,
                           const std::vector<ViewId>& views) {
  std::string names;
  for (const ViewId view : views) {
    names += (names.empty() ? "" : ", ") + scene.views.at(view).filename;
  }
  return names;
}

}  // namespace lowlap
