#include "third_party_adapters/line3dpp/internal/scene_format.h"

#include <utility>

#include "third_party_adapters/line3dpp/internal/line3dpp.h"

namespace lowlap::line3dpp {

SceneFormats Line3dppFormats() {
  SceneFormat format;
  format.name = "line3dpp";
  format.description =
      "lines of Line3D++ as text, with the segments that support them";
  format.recognizes_start = IsLine3dppStart;
  format.holds = {SceneContent::kLineTracks, SceneContent::kLines,
                  SceneContent::kLineObservations};
  format.read = ReadOneFile(ParseLine3dpp);
  format.write = WriteOneFile(FormatLine3dpp);
  return {std::move(format)};
}

}  // namespace lowlap::line3dpp
