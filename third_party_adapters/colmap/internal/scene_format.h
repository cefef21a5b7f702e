#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::colmap {

/// COLMAP's models as "colmap" (text) and "colmap-bin" folders, and its
/// databases as "colmap-db" (*.db). A folder with both forms is recognised as
/// "colmap-bin", the form that COLMAP would read.
///
/// A model is written as three files. Where the folder has rigs and frames of
/// this form, they are written too, as COLMAP would take their poses. Names
/// that could not be read again are kUnsupported (CheckImageName).
SceneFormats ColmapFormats();

}  // namespace lowlap::colmap
