#include "third_party_adapters/openmvg/sfm_data.h"

#include <cctype>
#include <filesystem>

#include "lowlap/io/scene_json.h"
#include "third_party_adapters/openmvg/sfm_data_bin.h"
#include "third_party_adapters/openmvg/sfm_data_xml.h"

namespace lowlap::openmvg {

Result<Scene> ReadSfmData(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (extension == ".json") return ReadSceneJson(path);
  if (extension == ".bin") return ReadSfmDataBin(path);
  if (extension == ".xml") return ReadSfmDataXml(path);
  return MakeError(ErrorCode::kUnsupported,
                   "an sfm_data file ends in .json, .bin or .xml", path);
}

}  // namespace lowlap::openmvg
