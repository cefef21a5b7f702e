#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::colmap {

/// COLMAP's models as "colmap" (text) and "colmap-bin" folders, and its
/// databases as "colmap-db" (*.db). Reading takes either form of a model.
///
/// A model is written as three files. Where the folder has rigs and frames of
/// this form, they are written too, as COLMAP would take their poses.
SceneFormats ColmapFormats();

}  // namespace lowlap::colmap
