#pragma once

#include <string>

#include "lowlap/core/ids.h"
#include "lowlap/scene/view.h"

namespace lowlap {

/// What an image is called where a format must have a name: its path below the
/// image folder, or "image" and the id of its view. The file's own numbers may
/// count from elsewhere, and would pair it with another view.
inline std::string ImageName(ViewId id, const View& view) {
  const std::string path = view.PathBelowRoot();
  return path.empty() ? "image" + std::to_string(id.value()) : path;
}

}  // namespace lowlap
