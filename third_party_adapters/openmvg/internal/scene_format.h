#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::openmvg {

/// OpenMVG's sfm_data as "openmvg-json", "openmvg-bin" (*.bin) and
/// "openmvg-xml" (*.xml). What is written is PrepareForOpenMvg(scene).
SceneFormats OpenMvgFormats();

}  // namespace lowlap::openmvg
