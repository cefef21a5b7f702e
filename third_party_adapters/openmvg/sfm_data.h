#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap::openmvg {

/// Reads an sfm_data file in the form that its extension names (.json, .bin or
/// .xml in any case, as OpenMVG does); kUnsupported for another one.
Result<Scene> ReadSfmData(const std::string& path);

}  // namespace lowlap::openmvg
