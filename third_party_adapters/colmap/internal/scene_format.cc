#include "third_party_adapters/colmap/internal/scene_format.h"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/colmap/internal/database.h"
#include "third_party_adapters/colmap/internal/model.h"
#include "third_party_adapters/colmap/internal/model_scene.h"

namespace lowlap::colmap {
namespace {

namespace fs = std::filesystem;

template <class Value>
Result<Value> WithFile(Result<Value> result, const std::string& file) {
  if (!result && result.error().file.empty()) result.error().file = file;
  return result;
}

Result<Scene> ReadModelScene(const std::string& folder, ModelForm form,
                             SceneNotes* notes) {
  const auto model = ReadModel(folder, form);
  if (!model) return tl::unexpected<Error>(model.error());
  return WithFile(SceneFromModel(*model, notes), folder);
}

bool Exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

Status CheckImageNames(const Model& model, const std::string& folder,
                       ModelForm form) {
  constexpr std::string_view kEndsText(" \t\r\n\0", 5), kEndsBinary("\0", 1);
  const std::string_view ends =
      form == ModelForm::kText ? kEndsText : kEndsBinary;
  const std::string file = PartPath(folder, "images", form);
  for (const Image& image : model.images) {
    LOWLAP_RETURN_IF_ERROR(CheckImageName(image.id, image.name, ends, file));
  }
  return {};
}

Result<SceneNotes> WriteModelScene(const Scene& scene,
                                   const std::string& folder, ModelForm form,
                                   FileSet* files) {
  SceneNotes notes;
  auto model = WithFile(ModelFromScene(scene, &notes), folder);
  if (!model) return tl::unexpected<Error>(model.error());
  if (form == ModelForm::kText && HasModel(folder, ModelForm::kBinary)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the folder has a binary model, which COLMAP would read "
                     "instead of a text one",
                     folder);
  }
  LOWLAP_RETURN_IF_ERROR(CheckImageNames(*model, folder, form));
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return MakeError(ErrorCode::kIo,
                     "cannot be made a folder: " + error.message(), folder);
  }
  const bool has_rigs = Exists(PartPath(folder, "rigs", form)) ||
                        Exists(PartPath(folder, "frames", form));
  if (has_rigs) AddTrivialRigs(&*model);
  for (const std::string name : kModelParts) {
    if (!has_rigs && (name == "rigs" || name == "frames")) continue;
    const Status added = files->Add(
        PartPath(folder, name, form),
        (form == ModelForm::kText ? FormatText : FormatBinary)(*model, name));
    if (!added) return tl::unexpected<Error>(added.error());
  }
  return notes;
}

SceneFormat ModelFormat(const char* name, const char* description,
                        ModelForm form) {
  SceneFormat format;
  format.name = name;
  format.description = description;
  format.recognizes_folder = [form](const std::string& folder) {
    return HasModel(folder, form);
  };
  format.holds = {SceneContent::kNames,  SceneContent::kIntrinsics,
                  SceneContent::kFrames, SceneContent::kDistortions,
                  SceneContent::kPoses,  SceneContent::kKeypoints,
                  SceneContent::kPoints, SceneContent::kObservations};
  format.needs = {SceneContent::kPoses, SceneContent::kIntrinsics};
  format.read = [form](const std::string& folder, SceneNotes* notes) {
    return ReadModelScene(folder, form, notes);
  };
  format.write = [form](const Scene& scene, const std::string& folder,
                        FileSet* files) {
    return WriteModelScene(scene, folder, form, files);
  };
  return format;
}

}  // namespace

SceneFormats ColmapFormats() {
  SceneFormat database;
  database.name = "colmap-db";
  database.description =
      "COLMAP's database (*.db); relative poses and their matches are written "
      "into one that has the same keypoints";
  database.extension = ".db";
  database.recognizes_start = IsDatabaseStart;
  database.holds = {SceneContent::kNames,        SceneContent::kIntrinsics,
                    SceneContent::kFrames,       SceneContent::kDistortions,
                    SceneContent::kKeypoints,    SceneContent::kRelativePoses,
                    SceneContent::kPointMatches, SceneContent::kPointTracks};
  database.read = ReadDatabaseScene;
  database.check_place = CheckDatabaseToUpdate;
  database.write = [](const Scene& scene, const std::string& path,
                      FileSet*) -> Result<SceneNotes> {
    return WriteRelativePoses(scene, path);
  };
  return {ModelFormat("colmap-bin",
                      "COLMAP's model: a folder with cameras.bin, images.bin, "
                      "points3D.bin",
                      ModelForm::kBinary),
          ModelFormat("colmap", "the same as text (cameras.txt, ...)",
                      ModelForm::kText),
          std::move(database)};
}

}  // namespace lowlap::colmap
