#include "lowlap/io/scene_format.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/io/internal/ply.h"
#include "lowlap/io/internal/scene_binary.h"

namespace lowlap {

bool SceneFormat::Recognizes(const std::string& path) const {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return recognizes_folder && recognizes_folder(path);
  }
  std::string own = std::filesystem::path(path).extension().string();
  std::transform(own.begin(), own.end(), own.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return !extension.empty() && own == extension;
}

SceneFormats OwnSceneFormats() {
  SceneFormat json;
  json.name = "json";
  json.description =
      "sfm_data JSON with lowlap's own sections, read by OpenMVG (*.json)";
  json.extension = ".json";
  json.recognizes_start = [](std::string_view start) {
    const std::size_t first = start.find_first_not_of(" \t\r\n");
    return first != start.npos && start[first] == '{';
  };
  json.read = [](const std::string& path, SceneNotes*) {
    return ReadSceneJson(path);
  };
  json.write = WriteOneFile(FormatSceneJson);

  SceneFormat binary;
  binary.name = "lowlap";
  binary.description = "the same content in binary, fast to load (*.lowlap)";
  binary.extension = ".lowlap";
  binary.read = [](const std::string& path, SceneNotes*) {
    return ReadSceneBinary(path);
  };
  binary.write = WriteOneFile(FormatSceneBinary);

  SceneFormat ply;
  ply.name = "ply";
  ply.description =
      "points, lines and cameras for viewers (*.ply), written only";
  ply.extension = ".ply";
  ply.write = WriteOneFile(FormatPly);
  return {std::move(json), std::move(binary), std::move(ply)};
}

std::string DescribeSceneFormats(const SceneFormats& formats) {
  std::string text;
  for (const SceneFormat& format : formats) {
    text += "  " + format.name + ": " + format.description + "\n";
  }
  return text;
}

Result<const SceneFormat*> FindSceneFormat(const SceneFormats& formats,
                                           const std::string& path) {
  for (const SceneFormat& format : formats) {
    if (format.Recognizes(path)) return &format;
  }
  return MakeError(
      ErrorCode::kUnsupported,
      "not a known scene format; known are\n" + DescribeSceneFormats(formats),
      path);
}

Result<const SceneFormat*> FindNamedSceneFormat(const SceneFormats& formats,
                                                const std::string& name) {
  for (const SceneFormat& format : formats) {
    if (format.name == name) return &format;
  }
  return MakeError(ErrorCode::kUnsupported, "there is no scene format '" +
                                                name + "'; there are:\n" +
                                                DescribeSceneFormats(formats));
}

std::function<Result<SceneNotes>(const Scene&, const std::string& path,
                                 FileSet* files)>
WriteOneFile(std::function<Result<std::string>(const Scene&)> format) {
  return
      [format = std::move(format)](const Scene& scene, const std::string& path,
                                   FileSet* files) -> Result<SceneNotes> {
        const Result<std::string> bytes = format(scene);
        Status status;
        if (bytes) {
          status = files->Add(path, *bytes);
        } else {
          status = tl::unexpected<Error>(bytes.error());
        }
        if (status) return SceneNotes();
        if (status.error().file.empty()) status.error().file = path;
        return tl::unexpected<Error>(std::move(status.error()));
      };
}

}  // namespace lowlap
