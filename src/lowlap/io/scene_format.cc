#include "lowlap/io/scene_format.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "lowlap/io/scene_binary.h"
#include "lowlap/io/scene_json.h"

namespace lowlap {
namespace {

// Whether the path is no folder and ends with an extension, in any case.
bool IsFileWithExtension(const std::string& path,
                         const std::string& lower_case_extension) {
  std::error_code ignored;
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == lower_case_extension &&
         !std::filesystem::is_directory(path, ignored);
}

class JsonFormat : public SceneFormat {
 public:
  std::string Name() const override { return "json"; }
  std::string Description() const override {
    return "sfm_data JSON with lowlap's own sections, read by OpenMVG (*.json)";
  }
  bool Recognizes(const std::string& path) const override {
    return IsFileWithExtension(path, ".json");
  }
  Result<Scene> Read(const std::string& path) const override {
    return ReadSceneJson(path);
  }
  bool CanWrite() const override { return true; }
  Status Write(const Scene& scene, const std::string& path) const override {
    return WriteSceneJson(scene, path);
  }
};

class BinaryFormat : public SceneFormat {
 public:
  std::string Name() const override { return "lowlap"; }
  std::string Description() const override {
    return "the same content in binary, fast to load (*.lowlap)";
  }
  bool Recognizes(const std::string& path) const override {
    return IsFileWithExtension(path, ".lowlap");
  }
  Result<Scene> Read(const std::string& path) const override {
    return ReadSceneBinary(path);
  }
  bool CanWrite() const override { return true; }
  Status Write(const Scene& scene, const std::string& path) const override {
    return WriteSceneBinary(scene, path);
  }
};

}  // namespace

Status SceneFormat::Write(const Scene&, const std::string& path) const {
  return MakeError(ErrorCode::kUnsupported,
                   "the format " + Name() + " cannot be written", path);
}

SceneFormats OwnSceneFormats() {
  SceneFormats formats;
  formats.push_back(std::make_unique<JsonFormat>());
  formats.push_back(std::make_unique<BinaryFormat>());
  return formats;
}

Result<const SceneFormat*> FindSceneFormat(const SceneFormats& formats,
                                           const std::string& path) {
  std::string known;
  for (const auto& format : formats) {
    if (format->Recognizes(path)) return format.get();
    known += "\n  " + format->Name() + ": " + format->Description();
  }
  return MakeError(ErrorCode::kUnsupported,
                   "not a known scene format; known are" + known, path);
}

}  // namespace lowlap
