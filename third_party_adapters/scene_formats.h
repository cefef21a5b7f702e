#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Every scene format there is:
///   json          .json    everything; OpenMVG loads its part of it
///   lowlap        .lowlap  everything
///   openmvg-json  -        what OpenMVG holds and nothing else
///   openmvg-bin   .bin     what OpenMVG holds
///   openmvg-xml   .xml     what OpenMVG holds
///   1dsfm         folder   a problem of 1DSfM; read only
///   ply           .ply     points, lines and cameras; written only
SceneFormats AllSceneFormats();

/// One line per format, for help texts and messages.
std::string DescribeSceneFormats();

/// Reads a scene file or folder. An sfm_data file is told by its first bytes,
/// so that a wrong extension does no harm; other files by the extension.
/// kUnsupported, with the list of formats, for anything else.
Result<Scene> ReadScene(const std::string& path);

/// Writes a scene in the format of the extension, or in the one called `format`
/// if it is given. Returns notes: one sentence for each thing that the format
/// cannot hold and that was changed or left out. kUnsupported, with the list
/// of formats, for an unknown one.
Result<std::vector<std::string>> WriteScene(const Scene& scene,
                                            const std::string& path,
                                            const std::string& format = {});

}  // namespace lowlap
