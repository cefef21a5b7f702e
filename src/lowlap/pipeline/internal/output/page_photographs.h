#pragma once

#include <map>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Small JPEG files of the views' photographs (Scene::ImagePath), 480 px wide,
/// less where there are more than a hundred. Photographs that are not there or
/// cannot be read are left out: the page does without. kCancelled.
Result<std::map<ViewId, std::string>> PagePhotographs(
    const Scene& scene, const RunContext& context);

}  // namespace lowlap
