#include "third_party_adapters/bundler/internal/scene_format.h"

#include <cstdint>
#include <filesystem>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/bundler/internal/bal.h"
#include "third_party_adapters/bundler/internal/bundle.h"
#include "third_party_adapters/bundler/internal/image_list.h"
#include "third_party_adapters/bundler/internal/nvm.h"

namespace lowlap::bundler {
namespace {

namespace fs = std::filesystem;

/// NAME.list.txt of NAME.out or NAME.bundle.out.
fs::path ListPath(const std::string& bundle_path) {
  fs::path path(bundle_path);
  for (const char* extension : {".out", ".bundle"}) {
    if (path.extension() == extension) path.replace_extension();
  }
  return path += ".list.txt";
}

/// Names from the list beside a file, if there is one.
Status ReadNames(const std::string& bundle_path, CenteredModel* model) {
  for (const fs::path& path :
       {ListPath(bundle_path),
        fs::path(bundle_path).parent_path() / "list.txt"}) {
    const Result<std::string> text = ReadWholeFile(path.string());
    if (!text && text.error().code == ErrorCode::kNotFound) continue;
    if (!text) return tl::unexpected<Error>(text.error());
    LOWLAP_ASSIGN_OR_RETURN(const auto images, ParseList(*text, path.string()));
    if (images.size() > model->cameras.size()) {
      return MakeError(ErrorCode::kInvalidScene,
                       "lists " + std::to_string(images.size()) +
                           " images, where the bundle file has " +
                           std::to_string(model->cameras.size()) + " cameras",
                       path.string());
    }
    for (std::size_t n = 0; n < images.size(); ++n) {
      model->cameras[n].name = images[n].name;
    }
    break;
  }
  return {};
}

Result<Scene> ParseBundleScene(std::string_view text, const std::string& file,
                               SceneNotes* notes) {
  LOWLAP_ASSIGN_OR_RETURN(CenteredModel model, ParseBundle(text, file));
  LOWLAP_RETURN_IF_ERROR(ReadNames(file, &model));
  return SceneFromModel(model, notes);
}

Result<SceneNotes> WriteBundleScene(const Scene& scene, const std::string& path,
                                    FileSet* files) {
  SceneNotes notes;
  LOWLAP_ASSIGN_OR_RETURN(
      const CenteredModel model,
      ModelFromScene(scene, RadialForm::kDistorts, Unsolved::kKept, &notes));
  std::string list;
  bool has_names = false;
  for (const CenteredCamera& camera : model.cameras) {
    LOWLAP_RETURN_IF_ERROR(CheckListedName(camera.name));
    list += camera.name + "\n";
    has_names = has_names || !camera.name.empty();
  }
  LOWLAP_RETURN_IF_ERROR(files->Add(path, FormatBundle(model)));
  if (has_names) {
    LOWLAP_RETURN_IF_ERROR(files->Add(ListPath(path).string(), list));
  }
  return notes;
}

Result<Scene> ParseNvmScene(std::string_view text, const std::string& file,
                            SceneNotes* notes) {
  LOWLAP_ASSIGN_OR_RETURN(const auto model, ParseNvm(text, file, notes));
  return SceneFromModel(model, notes);
}

Result<std::string> FormatNvmScene(const Scene& scene, SceneNotes* notes) {
  LOWLAP_ASSIGN_OR_RETURN(const CenteredModel model,
                          ModelFromScene(scene, RadialForm::kUndistorts,
                                         Unsolved::kLeftOut, notes));
  return FormatNvm(model);
}

Result<Scene> ParseBalScene(std::string_view text, const std::string& file,
                            SceneNotes* notes) {
  LOWLAP_ASSIGN_OR_RETURN(const auto model, ParseBal(text, file));
  return SceneFromModel(model, notes);
}

/// Whether the places of solved views, which are their ids when the file is
/// read, are the ids that they have.
bool PlacesAreIds(const Scene& scene) {
  std::uint32_t place = 0;
  for (const auto& entry : scene.views) {
    const ViewId id = entry.first;
    if (!scene.FindPose(id) || !scene.FindIntrinsic(id)) continue;
    if (id != place) return false;
    ++place;
  }
  return true;
}

Result<std::string> FormatBalScene(const Scene& scene, SceneNotes* notes) {
  LOWLAP_ASSIGN_OR_RETURN(
      const CenteredModel model,
      ModelFromScene(scene, RadialForm::kDistorts, Unsolved::kLeftOut, notes));
  if (!PlacesAreIds(scene)) {
    notes->push_back(
        "the solved views' ids are not 0, 1, 2, ...: camera n of the file is "
        "the n-th of them in the order of ids, from 0");
  }
  return FormatBal(model);
}

}  // namespace

SceneFormats BundlerFormats() {
  SceneFormat bundle;
  bundle.name = "bundler";
  bundle.description =
      "Bundler's output (*.out, named as in *.list.txt or list.txt)";
  bundle.extension = ".out";
  bundle.recognizes_start = [](std::string_view start) {
    return start.substr(0, 13) == "# Bundle file";
  };
  bundle.holds = {SceneContent::kIntrinsics, SceneContent::kDistortions,
                  SceneContent::kPoses, SceneContent::kPoints,
                  SceneContent::kObservations};
  bundle.needs = {SceneContent::kPoses, SceneContent::kIntrinsics};
  bundle.read = ReadOneFile(ParseBundleScene);
  bundle.write = WriteBundleScene;

  SceneFormat bal = bundle;
  bal.name = "bal";
  bal.description = "problem of Bundle Adjustment in the Large (*.bal)";
  bal.extension = ".bal";
  bal.recognizes_start = IsBalStart;
  bal.read = ReadOneFile(ParseBalScene);
  bal.write = WriteOneFile(FormatBalScene);

  SceneFormat nvm = bundle;
  nvm.name = "nvm";
  nvm.description = "N-View Match file of VisualSFM (*.nvm)";
  nvm.extension = ".nvm";
  nvm.recognizes_start = [](std::string_view start) {
    return start.substr(0, 6) == "NVM_V3";
  };
  nvm.read = ReadOneFile(ParseNvmScene);
  nvm.write = WriteOneFile(FormatNvmScene);

  bundle.holds.insert(SceneContent::kNames);
  nvm.holds.insert(SceneContent::kNames);
  return {std::move(bundle), std::move(nvm), std::move(bal)};
}

}  // namespace lowlap::bundler
