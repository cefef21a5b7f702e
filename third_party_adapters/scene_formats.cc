#include "third_party_adapters/scene_formats.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/bundler/internal/scene_format.h"
#include "third_party_adapters/colmap/internal/scene_format.h"
#include "third_party_adapters/limap/internal/scene_format.h"
#include "third_party_adapters/line3dpp/internal/scene_format.h"
#include "third_party_adapters/onedsfm/internal/scene_format.h"
#include "third_party_adapters/openmvg/internal/scene_format.h"
#include "third_party_adapters/trajectories/internal/scene_format.h"

namespace lowlap {
namespace {

// One line per adapter.
constexpr SceneFormats (*kAdapters[])() = {
    openmvg::OpenMvgFormats,         onedsfm::OneDSfmFormats,
    colmap::ColmapFormats,           limap::LimapFormats,
    line3dpp::Line3dppFormats,       bundler::BundlerFormats,
    trajectories::TrajectoryFormats,
};

/// The format of a file or folder that is there: the one that its first bytes
/// tell, else FindSceneFormat.
Result<const SceneFormat*> FindFormatOf(const SceneFormats& formats,
                                        const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return MakeError(
        ErrorCode::kNotFound,
        error ? "cannot be opened: " + error.message() : "no such file", path);
  }
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 4096> buffer{};
  stream.read(buffer.data(), buffer.size());
  const std::string_view start(buffer.data(),
                               static_cast<std::size_t>(stream.gcount()));
  for (const SceneFormat& format : formats) {
    if (format.recognizes_start && format.recognizes_start(start)) {
      return &format;
    }
  }
  return FindSceneFormat(formats, path);
}

/// One to write: by name, or where none is given by the path.
Result<const SceneFormat*> FindFormatToWrite(const SceneFormats& formats,
                                             const std::string& path,
                                             const std::string& name) {
  LOWLAP_ASSIGN_OR_RETURN(const SceneFormat* chosen,
                          name.empty() ? FindSceneFormat(formats, path)
                                       : FindNamedSceneFormat(formats, name));
  if (!chosen->write) {
    return MakeError(ErrorCode::kUnsupported,
                     "the format " + chosen->name + " cannot be written", path);
  }
  return chosen;
}

template <class Value>
Result<Value> WithPath(Result<Value> result, const std::string& path) {
  if (!result && result.error().file.empty()) result.error().file = path;
  return result;
}

}  // namespace

SceneFormats AllSceneFormats() {
  SceneFormats formats = OwnSceneFormats();
  for (const auto& adapter : kAdapters) {
    for (SceneFormat& format : adapter()) formats.push_back(std::move(format));
  }
  return formats;
}

bool IsScene(const std::string& path) {
  return FindFormatOf(AllSceneFormats(), path).has_value();
}

Result<Scene> ReadScene(const std::string& path, SceneNotes* notes,
                        const std::string& format) {
  const SceneFormats formats = AllSceneFormats();
  LOWLAP_ASSIGN_OR_RETURN(const SceneFormat* chosen,
                          format.empty()
                              ? FindFormatOf(formats, path)
                              : FindNamedSceneFormat(formats, format));
  if (!chosen->read) {
    return MakeError(ErrorCode::kUnsupported,
                     "the format " + chosen->name + " cannot be read", path);
  }
  SceneNotes ignored;
  return WithPath(chosen->read(path, notes == nullptr ? &ignored : notes),
                  path);
}

Status CheckScenePlace(const std::string& path, const std::string& format) {
  const SceneFormats formats = AllSceneFormats();
  LOWLAP_ASSIGN_OR_RETURN(const SceneFormat* chosen,
                          FindFormatToWrite(formats, path, format));
  return chosen->check_place ? chosen->check_place(path) : Status();
}

Result<SceneNotes> WriteScene(const Scene& scene, const std::string& path,
                              const std::string& format, FileSet* files) {
  const SceneFormats formats = AllSceneFormats();
  LOWLAP_ASSIGN_OR_RETURN(const SceneFormat* chosen,
                          FindFormatToWrite(formats, path, format));
  LOWLAP_ASSIGN_OR_RETURN(SceneNotes notes,
                          WithPath(chosen->write(scene, path, files), path));
  if (std::string loss = LossNote(*chosen, scene); !loss.empty()) {
    notes.insert(notes.begin(), std::move(loss));
  }
  return notes;
}

Result<SceneNotes> WriteScene(const Scene& scene, const std::string& path,
                              const std::string& format) {
  FileSet files;
  Result<SceneNotes> notes = WriteScene(scene, path, format, &files);
  if (!notes) return notes;
  LOWLAP_RETURN_IF_ERROR(files.Commit());
  return notes;
}

}  // namespace lowlap
