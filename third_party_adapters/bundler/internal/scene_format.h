#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::bundler {

/// "bundler" (*.out): a bundle.out, with the names of its images in the list
/// NAME.list.txt of NAME.out or NAME.bundle.out, or in list.txt beside it;
/// "nvm" (*.nvm); "bal" (*.bal, or told by its first lines).
SceneFormats BundlerFormats();

}  // namespace lowlap::bundler
