#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::onedsfm {

/// "1dsfm": problem folders (problem.h), read only.
SceneFormats OneDSfmFormats();

}  // namespace lowlap::onedsfm
