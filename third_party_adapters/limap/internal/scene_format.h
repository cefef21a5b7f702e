#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::limap {

/// "limap": folders of LIMAP (line_folder.h).
SceneFormats LimapFormats();

}  // namespace lowlap::limap
