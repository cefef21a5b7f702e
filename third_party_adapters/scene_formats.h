#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// One supported scene file format, for help texts.
struct SceneFormatInfo {
  std::string name;         // "lowlap-json", "openmvg-bin", ...
  std::string description;  // one line
  std::string extension;    // with the dot
  bool can_read = false;
  bool can_write = false;
};

/// Every format that ReadScene and WriteScene know:
///   lowlap-json    .json    everything; OpenMVG loads its part of it
///   lowlap-binary  .lowlap  everything
///   openmvg-json   .json    what OpenMVG holds (written only on request)
///   openmvg-bin    .bin     what OpenMVG holds
///   openmvg-xml    .xml     what OpenMVG holds
///   ply            .ply     points, lines and cameras, written only
const std::vector<SceneFormatInfo>& SceneFormats();

/// Reads a scene file. The format is told by the content, so that a wrong
/// extension does no harm. kUnsupported, with the list of formats, if no format
/// recognises the file.
Result<Scene> ReadScene(const std::string& path);

/// Writes a scene file in the format of the extension, or in `format` (a name
/// of the table above) if it is given. Returns notes: what the format could not
/// hold and was changed or left out. Errors: kUnsupported with the list.
Result<std::vector<std::string>> WriteScene(const Scene& scene,
                                            const std::string& path,
                                            const std::string& format = {});

}  // namespace lowlap
