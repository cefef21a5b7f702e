#include "third_party_adapters/openmvg/internal/scene_format.h"

#include <algorithm>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/openmvg/internal/prepare.h"
#include "third_party_adapters/openmvg/internal/sfm_data_bin.h"
#include "third_party_adapters/openmvg/internal/sfm_data_xml.h"

namespace lowlap::openmvg {
namespace {

// The endianness byte, then the length 3 of "0.1" to "0.3" in eight bytes.
bool IsBinStart(std::string_view start) {
  return start.size() >= 12 && start.substr(9, 2) == "0." &&
         ((start[0] == 1 && start[1] == 3 && start[8] == 0) ||
          (start[0] == 0 && start[1] == 0 && start[8] == 3));
}

bool IsXmlStart(std::string_view start) {
  start.remove_prefix(
      std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  return start.substr(0, 5) == "<?xml" || start.substr(0, 7) == "<cereal";
}

Result<std::string> FormatBin(const Scene& scene) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  return SerializeSfmDataBin(scene);
}

template <class FormatScene>
auto WritePrepared(FormatScene format) {
  return [write = WriteOneFile(format)](const Scene& scene,
                                        const std::string& path,
                                        FileSet* files) -> Result<SceneNotes> {
    PreparedScene prepared = PrepareForOpenMvg(scene);
    LOWLAP_RETURN_IF_ERROR(write(prepared.scene, path, files));
    return std::move(prepared.notes);
  };
}

const SceneContents kHeld = {
    SceneContent::kRootPath,     SceneContent::kNames,
    SceneContent::kIntrinsics,   SceneContent::kFrames,
    SceneContent::kDistortions,  SceneContent::kPoses,
    SceneContent::kSharedPoses,  SceneContent::kCenterPriors,
    SceneContent::kPoints,       SceneContent::kObservations,
    SceneContent::kControlPoints};

}  // namespace

SceneFormats OpenMvgFormats() {
  SceneFormat json;
  json.name = "openmvg-json";
  json.description =
      "OpenMVG's sfm_data as JSON, without what OpenMVG does not know";
  json.holds = kHeld;
  json.read = [](const std::string& path, SceneNotes*) {
    return ReadSceneJson(path);
  };
  json.write = WritePrepared(FormatSceneJson);

  SceneFormat bin;
  bin.name = "openmvg-bin";
  bin.description = "OpenMVG's sfm_data.bin (*.bin)";
  bin.extension = ".bin";
  bin.recognizes_start = IsBinStart;
  bin.holds = kHeld;
  bin.read = [](const std::string& path, SceneNotes*) {
    return ReadSfmDataBin(path);
  };
  bin.write = WritePrepared(FormatBin);

  SceneFormat xml;
  xml.name = "openmvg-xml";
  xml.description = "OpenMVG's sfm_data.xml (*.xml)";
  xml.extension = ".xml";
  xml.recognizes_start = IsXmlStart;
  xml.holds = kHeld;
  xml.read = [](const std::string& path, SceneNotes*) {
    return ReadSfmDataXml(path);
  };
  xml.write = WritePrepared(FormatSfmDataXml);
  return {std::move(json), std::move(bin), std::move(xml)};
}

}  // namespace lowlap::openmvg
