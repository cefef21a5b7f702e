#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap::openmvg {

/// OpenMVG's `sfm_data.xml` (cereal's XML archive). It has the items of
/// sfm_data.json in the same nesting; errors are those of the JSON reader, with
/// the place given as the path in the JSON form, and kParse with a byte offset
/// for text that is not XML.
Result<Scene> ReadSfmDataXml(const std::string& path);
Result<Scene> ParseSfmDataXml(const std::string& text,
                              const std::string& file = {});

/// The text of a scene as it is (without what OpenMVG does not know), all
/// numbers with 17 digits. kInvalidScene if ValidateScene refuses it.
Result<std::string> FormatSfmDataXml(const Scene& scene);

}  // namespace lowlap::openmvg
