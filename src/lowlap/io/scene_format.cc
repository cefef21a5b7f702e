#include "lowlap/io/scene_format.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/io/internal/obj.h"
#include "lowlap/io/internal/ply.h"
#include "lowlap/io/internal/scene_binary.h"

namespace lowlap {
namespace {

template <class Value>
Result<Value> WithFile(Result<Value> result, const std::string& file) {
  if (!result && result.error().file.empty()) result.error().file = file;
  return result;
}

}  // namespace

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
  json.holds = AllContents();
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
  binary.holds = AllContents();
  binary.read = [](const std::string& path, SceneNotes*) {
    return ReadSceneBinary(path);
  };
  binary.write = WriteOneFile(FormatSceneBinary);

  SceneFormat ply;
  ply.name = "ply";
  ply.description = "points, lines and cameras for viewers (*.ply)";
  ply.extension = ".ply";
  ply.holds = {SceneContent::kPoses, SceneContent::kPoints,
               SceneContent::kLines};
  ply.write = WriteOneFile(FormatPly);

  SceneFormat obj;
  obj.name = "obj";
  obj.description =
      "the same without colours, segments first, as LIMAP reads them (*.obj)";
  obj.extension = ".obj";
  obj.holds = ply.holds;
  obj.write = WriteOneFile(FormatObj);
  return {std::move(json), std::move(binary), std::move(ply), std::move(obj)};
}

std::string DescribeSceneFormats(const SceneFormats& formats) {
  std::string text;
  for (const SceneFormat& format : formats) {
    text += "  " + format.name + ": " + format.description + "\n";
  }
  return text;
}

std::string TabulateSceneFormats(const SceneFormats& formats) {
  std::string text;
  for (const SceneFormat& format : formats) {
    const char* access = !format.read    ? "written only"
                         : !format.write ? "read only"
                                         : "read and written";
    text += format.name + " (" + access + "): " + format.description +
            "\n    holds " + DescribeContents(format.holds) + "\n";
    if (!format.needs.empty()) {
      text += "    cameras of views that have " +
              DescribeContents(format.needs) + "\n";
    }
  }
  return text;
}

std::string LossNote(const SceneFormat& format, const Scene& scene) {
  const std::string loss = DescribeLoss(scene, format.holds);
  return loss.empty() ? loss
                      : format.name + " cannot hold " + loss + ": left out";
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

std::function<Result<Scene>(const std::string& path, SceneNotes* notes)>
ReadOneFile(std::function<Result<Scene>(std::string_view bytes,
                                        const std::string& file, SceneNotes*)>
                parse) {
  return [parse = std::move(parse)](const std::string& path,
                                    SceneNotes* notes) -> Result<Scene> {
    LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
    return WithFile(parse(bytes, path, notes), path);
  };
}

std::function<Result<SceneNotes>(const Scene&, const std::string& path,
                                 FileSet* files)>
WriteOneFile(
    std::function<Result<std::string>(const Scene&, SceneNotes*)> format) {
  return
      [format = std::move(format)](const Scene& scene, const std::string& path,
                                   FileSet* files) -> Result<SceneNotes> {
        SceneNotes notes;
        LOWLAP_ASSIGN_OR_RETURN(const std::string bytes,
                                WithFile(format(scene, &notes), path));
        LOWLAP_RETURN_IF_ERROR(files->Add(path, bytes));
        return notes;
      };
}

std::function<Result<SceneNotes>(const Scene&, const std::string& path,
                                 FileSet* files)>
WriteOneFile(std::function<Result<std::string>(const Scene&)> format) {
  return WriteOneFile(
      [format = std::move(format)](const Scene& scene, SceneNotes*) {
        return format(scene);
      });
}

}  // namespace lowlap
