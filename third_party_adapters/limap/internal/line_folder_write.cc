#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/obj.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/colmap/internal/model_scene.h"
#include "third_party_adapters/colmap/internal/scene_format.h"
#include "third_party_adapters/internal/file_lines.h"
#include "third_party_adapters/internal/image_name.h"
#include "third_party_adapters/internal/landmarks.h"
#include "third_party_adapters/limap/internal/folder_layout.h"
#include "third_party_adapters/limap/internal/line_folder.h"
#include "third_party_adapters/limap/internal/line_track.h"

namespace lowlap::limap {
namespace {

namespace fs = std::filesystem;

/// Writes into one folder; ids of views are `id_shift` more there.
class LineFolderWriter {
 public:
  LineFolderWriter(const Scene& scene, const std::string& folder,
                   FileSet* files)
      : scene_(scene),
        folder_(folder),
        files_(*files),
        id_shift_(colmap::IdShift(scene)) {}

  Status Write(SceneNotes* notes) {
    const IdTexts matches = MatchTexts();
    LOWLAP_RETURN_IF_ERROR(CheckFolder(matches));
    LOWLAP_RETURN_IF_ERROR(WriteImageList());
    LOWLAP_RETURN_IF_ERROR(WriteModel(notes));
    LOWLAP_RETURN_IF_ERROR(WriteSegments());
    LOWLAP_RETURN_IF_ERROR(WriteMatches(matches));
    return WriteLines(notes);
  }

 private:
  /// By the id of the image in the folder.
  using IdTexts = std::map<std::uint32_t, std::string>;

  std::uint32_t FileId(ViewId view) const { return view.value() + id_shift_; }

  /// LIMAP takes every file of these names for a part of the result.
  Status CheckFolder(const IdTexts& matches) const {
    const auto tracks =
        NumberedFiles((folder_ / kTrackFolder).string(), "track_", ".txt");
    if (!tracks.empty() && tracks.rbegin()->first >= NumLines()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "holds more lines than the scene; remove them first",
                       (folder_ / kTrackFolder).string());
    }
    LOWLAP_RETURN_IF_ERROR(
        CheckFiles(kSegmentFolder, "segments_", ".txt", [&](std::uint32_t id) {
          return id >= id_shift_ && scene_.features.count(id - id_shift_) > 0;
        }));
    // limap_text.py makes the one of the other.
    for (const char* extension : {".txt", ".npy"}) {
      LOWLAP_RETURN_IF_ERROR(
          CheckFiles(kMatchFolder, "matches_", extension,
                     [&](std::uint32_t id) { return matches.count(id) > 0; }));
    }
    return {};
  }

  template <class IsWritten>
  Status CheckFiles(const char* name, const char* prefix, const char* extension,
                    const IsWritten& is_written) const {
    for (const auto& [id, path] :
         NumberedFiles((folder_ / name).string(), prefix, extension)) {
      if (is_written(id)) continue;
      return MakeError(ErrorCode::kInvalidArgument,
                       "is of another result: the scene has none for this "
                       "image; remove it first",
                       path);
    }
    return {};
  }

  std::size_t NumLines() const { return scene_.line_structure.size(); }

  Status AddFile(const fs::path& name, const std::string& content) {
    const fs::path path = folder_ / name;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
      return MakeError(ErrorCode::kIo, "cannot be made: " + error.message(),
                       path.parent_path().string());
    }
    return files_.Add(path.string(), content);
  }

  Status WriteModel(SceneNotes* notes) {
    const SceneFormats formats = colmap::ColmapFormats();
    LOWLAP_ASSIGN_OR_RETURN(const SceneFormat* format,
                            FindNamedSceneFormat(formats, "colmap-bin"));
    LOWLAP_ASSIGN_OR_RETURN(
        const SceneNotes of_model,
        format->write(scene_, (folder_ / kModelFolder).string(), &files_));
    notes->insert(notes->end(), of_model.begin(), of_model.end());
    return {};
  }

  Status WriteImageList() {
    std::string text =
        "number of images, " + std::to_string(scene_.views.size()) + "\n";
    for (const auto& [id, view] : scene_.views) {
      const std::string name = ImageName(id, view);
      LOWLAP_RETURN_IF_ERROR(colmap::CheckImageName(
          FileId(id), name, {"\r\n\0", 3}, (folder_ / kImageList).string()));
      text += std::to_string(FileId(id)) + ", " + name + "\n";
    }
    return AddFile(kImageList, text);
  }

  Status WriteSegments() {
    for (const auto& [id, features] : scene_.features) {
      std::string text = std::to_string(features.segments.size()) + "\n";
      for (const LineSegment& segment : features.segments) {
        text += SegmentText(segment.start_px, segment.end_px) + "\n";
      }
      LOWLAP_RETURN_IF_ERROR(
          AddFile(fs::path(kSegmentFolder) /
                      ("segments_" + std::to_string(FileId(id)) + ".txt"),
                  text));
    }
    return {};
  }

  /// From both sides, as LIMAP matches.
  IdTexts MatchTexts() const {
    IdTexts texts;
    for (const auto& [views, pose] : scene_.relative_poses) {
      const std::uint32_t first = FileId(views.first);
      const std::uint32_t second = FileId(views.second);
      for (const FeatureMatch& match : pose.line_inliers) {
        texts[first] += Format("%u %u %u\n", second, match.first, match.second);
        texts[second] += Format("%u %u %u\n", first, match.second, match.first);
      }
    }
    return texts;
  }

  Status WriteMatches(const IdTexts& texts) {
    for (const auto& [id, text] : texts) {
      LOWLAP_RETURN_IF_ERROR(AddFile(
          fs::path(kMatchFolder) / ("matches_" + std::to_string(id) + ".txt"),
          text));
    }
    return {};
  }

  Status WriteLines(SceneNotes* notes) {
    std::size_t n = 0;
    for (FileLine& line : FileLinesOf(scene_, notes)) {
      for (SupportingSegment& segment : line.support) {
        segment.view = FileId(segment.view);
      }
      LOWLAP_RETURN_IF_ERROR(AddFile(
          fs::path(kTrackFolder) / ("track_" + std::to_string(n++) + ".txt"),
          FormatLineTrack(line)));
    }
    Scene lines;
    lines.line_structure = scene_.line_structure;
    LOWLAP_ASSIGN_OR_RETURN(const std::string obj, FormatObj(lines));
    return AddFile("triangulated_lines_nv2.obj", obj);
  }

  const Scene& scene_;
  const fs::path folder_;
  FileSet& files_;
  const std::uint32_t id_shift_;
};

}  // namespace

Result<SceneNotes> WriteLineFolder(const Scene& scene,
                                   const std::string& folder, FileSet* files) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  SceneNotes notes;
  LOWLAP_ASSIGN_OR_RETURN(const Scene undistorted,
                          UndistortedScene(scene, &notes));
  LOWLAP_RETURN_IF_ERROR(
      LineFolderWriter(undistorted, folder, files).Write(&notes));
  return notes;
}

}  // namespace lowlap::limap
