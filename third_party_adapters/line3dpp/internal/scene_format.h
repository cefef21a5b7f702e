#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::line3dpp {

/// "line3dpp": the lines of Line3D++ as text (line3dpp.h), told by its first
/// line.
SceneFormats Line3dppFormats();

}  // namespace lowlap::line3dpp
