#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Makes the folder (and its parents) if it does not exist; kIo if a file is
/// in the way or it cannot be written to.
Status PrepareOutputFolder(const std::string& folder);

/// Writes what every solving command leaves: sfm_data.json (OpenMVG loads it),
/// scene.lowlap (everything), cloud.ply (points, lines, cameras) and
/// summary.json (the given text). Each file appears whole or not at all.
Status WriteOutputs(const Scene& scene, const std::string& summary_json,
                    const std::string& folder);

}  // namespace lowlap
