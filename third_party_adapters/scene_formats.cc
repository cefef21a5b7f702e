#include "third_party_adapters/scene_formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "lowlap/io/ply.h"
#include "lowlap/io/scene_json.h"
#include "third_party_adapters/onedsfm/problem.h"
#include "third_party_adapters/openmvg/prepare.h"
#include "third_party_adapters/openmvg/sfm_data_bin.h"
#include "third_party_adapters/openmvg/sfm_data_xml.h"

namespace lowlap {
namespace {

bool HasExtension(const std::string& path, const std::string& extension) {
  std::string own = std::filesystem::path(path).extension().string();
  for (char& c : own) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return own == extension;
}

Status WithoutNotes(const Result<std::vector<std::string>>& notes) {
  if (!notes) return tl::unexpected<Error>(notes.error());
  return {};
}

class OpenMvgJsonFormat : public SceneFormat {
 public:
  std::string Name() const override { return "openmvg-json"; }
  std::string Description() const override {
    return "OpenMVG's sfm_data as JSON, without what OpenMVG does not know";
  }
  bool Recognizes(const std::string&) const override { return false; }
  Result<Scene> Read(const std::string& path) const override {
    return ReadSceneJson(path);
  }
  bool CanWrite() const override { return true; }
  Status Write(const Scene& scene, const std::string& path) const override {
    return WriteSceneJson(openmvg::PrepareForOpenMvg(scene).scene, path);
  }
};

class OpenMvgBinFormat : public SceneFormat {
 public:
  std::string Name() const override { return "openmvg-bin"; }
  std::string Description() const override {
    return "OpenMVG's sfm_data.bin (*.bin)";
  }
  bool Recognizes(const std::string& path) const override {
    return HasExtension(path, ".bin");
  }
  Result<Scene> Read(const std::string& path) const override {
    return openmvg::ReadSfmDataBin(path);
  }
  bool CanWrite() const override { return true; }
  Status Write(const Scene& scene, const std::string& path) const override {
    return WithoutNotes(openmvg::WriteSfmDataBin(scene, path));
  }
};

class OpenMvgXmlFormat : public SceneFormat {
 public:
  std::string Name() const override { return "openmvg-xml"; }
  std::string Description() const override {
    return "OpenMVG's sfm_data.xml (*.xml)";
  }
  bool Recognizes(const std::string& path) const override {
    return HasExtension(path, ".xml");
  }
  Result<Scene> Read(const std::string& path) const override {
    return openmvg::ReadSfmDataXml(path);
  }
  bool CanWrite() const override { return true; }
  Status Write(const Scene& scene, const std::string& path) const override {
    return WithoutNotes(openmvg::WriteSfmDataXml(scene, path));
  }
};

class OneDSfmFormat : public SceneFormat {
 public:
  std::string Name() const override { return "1dsfm"; }
  std::string Description() const override {
    return "a problem folder of 1DSfM (EGs.txt, cc.txt, ...), read only";
  }
  bool Recognizes(const std::string& path) const override {
    return onedsfm::IsProblemFolder(path);
  }
  Result<Scene> Read(const std::string& path) const override {
    auto problem = onedsfm::ReadProblem(path);
    if (!problem) return tl::unexpected<Error>(problem.error());
    return std::move(problem->scene);
  }
  bool CanWrite() const override { return false; }
};

class PlyFormat : public SceneFormat {
 public:
  std::string Name() const override { return "ply"; }
  std::string Description() const override {
    return "points, lines and cameras for viewers (*.ply), written only";
  }
  bool Recognizes(const std::string& path) const override {
    return HasExtension(path, ".ply");
  }
  Result<Scene> Read(const std::string& path) const override {
    return MakeError(ErrorCode::kUnsupported,
                     "a PLY file holds no cameras that could be read", path);
  }
  bool CanWrite() const override { return true; }
  Status Write(const Scene& scene, const std::string& path) const override {
    return WritePly(scene, path);
  }
};

/// Name of the format that the first bytes of an sfm_data file tell; empty for
/// other files.
std::string FormatOfContent(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 64> buffer{};
  stream.read(buffer.data(), buffer.size());
  std::string_view start(buffer.data(),
                         static_cast<std::size_t>(stream.gcount()));
  // The endianness byte, then the length 3 of "0.1" to "0.3" in eight bytes.
  if (start.size() >= 12 && start.substr(9, 2) == "0." &&
      ((start[0] == 1 && start[1] == 3 && start[8] == 0) ||
       (start[0] == 0 && start[1] == 0 && start[8] == 3))) {
    return "openmvg-bin";
  }
  start.remove_prefix(
      std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  if (start.substr(0, 1) == "{") return "json";
  if (start.substr(0, 5) == "<?xml" || start.substr(0, 7) == "<cereal") {
    return "openmvg-xml";
  }
  return {};
}

const SceneFormat* FindByName(const SceneFormats& formats,
                              const std::string& name) {
  for (const auto& format : formats) {
    if (format->Name() == name) return format.get();
  }
  return nullptr;
}

}  // namespace

SceneFormats AllSceneFormats() {
  SceneFormats formats = OwnSceneFormats();
  formats.push_back(std::make_unique<const OpenMvgJsonFormat>());
  formats.push_back(std::make_unique<const OpenMvgBinFormat>());
  formats.push_back(std::make_unique<const OpenMvgXmlFormat>());
  formats.push_back(std::make_unique<const OneDSfmFormat>());
  formats.push_back(std::make_unique<const PlyFormat>());
  return formats;
}

std::string DescribeSceneFormats() {
  std::string text;
  for (const auto& format : AllSceneFormats()) {
    text += "  " + format->Name() + ": " + format->Description() + "\n";
  }
  return text;
}

Result<Scene> ReadScene(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return MakeError(ErrorCode::kNotFound, "no such file", path);
  }
  const SceneFormats formats = AllSceneFormats();
  if (const SceneFormat* format = FindByName(formats, FormatOfContent(path))) {
    return format->Read(path);
  }
  const Result<const SceneFormat*> format = FindSceneFormat(formats, path);
  if (!format) return tl::unexpected<Error>(format.error());
  return (*format)->Read(path);
}

Result<std::vector<std::string>> WriteScene(const Scene& scene,
                                            const std::string& path,
                                            const std::string& format) {
  const SceneFormats formats = AllSceneFormats();
  const SceneFormat* chosen = nullptr;
  if (format.empty()) {
    const Result<const SceneFormat*> found = FindSceneFormat(formats, path);
    if (!found) return tl::unexpected<Error>(found.error());
    chosen = *found;
  } else {
    chosen = FindByName(formats, format);
    if (chosen == nullptr) {
      return MakeError(ErrorCode::kUnsupported, "there is no scene format '" +
                                                    format + "'; there are:\n" +
                                                    DescribeSceneFormats());
    }
  }
  std::vector<std::string> notes;
  if (chosen->Name().rfind("openmvg-", 0) == 0) {
    notes = openmvg::PrepareForOpenMvg(scene).notes;
  }
  if (Status status = chosen->Write(scene, path); !status) {
    return tl::unexpected<Error>(status.error());
  }
  return notes;
}

}  // namespace lowlap
