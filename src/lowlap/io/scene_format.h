#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_content.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

class FileSet;

/// One sentence for each kind of thing that a format cannot hold, or a reader
/// does not take, and that was changed or left out.
using SceneNotes = std::vector<std::string>;

/// A way to keep a scene on disk. A path is a file or a folder, as the format
/// likes. The functions have no state and may be called by several threads.
struct SceneFormat {
  /// A short word to select the format by ("lowlap", "openmvg-json", ...).
  std::string name;
  /// One line for a person.
  std::string description;
  /// In lower case, with its dot; empty if no extension tells the format.
  std::string extension;
  /// Whether the first bytes of a file are those of the format; may be null.
  std::function<bool(std::string_view)> recognizes_start;
  /// Whether a folder is of the format; may be null.
  std::function<bool(const std::string& folder)> recognizes_folder;
  /// What it keeps of a scene; the rest is left out when it is written.
  SceneContents holds;
  /// What a view must have for its camera, and what that sees, to be written.
  SceneContents needs;
  /// Null if it is written only. `notes` is never null.
  std::function<Result<Scene>(const std::string& path, SceneNotes* notes)> read;
  /// Whether a scene can be written to `path`, as far as that shows before
  /// there is one; null: always.
  std::function<Status(const std::string& path)> check_place;
  /// Adds what is to be written to `files`, but for a database, which is
  /// written into at once; null if it is read only.
  std::function<Result<SceneNotes>(const Scene&, const std::string& path,
                                   FileSet* files)>
      write;

  /// By extension or folder. The path need not exist: it may be one to write.
  bool Recognizes(const std::string& path) const;
};

using SceneFormats = std::vector<SceneFormat>;

/// The formats of this folder: "json" (*.json), "lowlap" (*.lowlap), and "ply"
/// (*.ply) and "obj" (*.obj), which are written only.
SceneFormats OwnSceneFormats();

/// A `read` and a `write` for formats that keep everything in one file, from
/// what takes its bytes apart and what makes them. Errors get the path.
std::function<Result<Scene>(const std::string& path, SceneNotes* notes)>
ReadOneFile(std::function<Result<Scene>(std::string_view bytes,
                                        const std::string& file, SceneNotes*)>
                parse);
std::function<Result<SceneNotes>(const Scene&, const std::string& path,
                                 FileSet* files)>
WriteOneFile(
    std::function<Result<std::string>(const Scene&, SceneNotes*)> format);
/// The same for what leaves nothing out but by `holds`.
std::function<Result<SceneNotes>(const Scene&, const std::string& path,
                                 FileSet* files)>
WriteOneFile(std::function<Result<std::string>(const Scene&)> format);

/// The first format that recognises the path, or kUnsupported with the list of
/// those that exist. The pointer belongs to `formats`.
Result<const SceneFormat*> FindSceneFormat(const SceneFormats& formats,
                                           const std::string& path);

/// The format called so, or kUnsupported with the list.
Result<const SceneFormat*> FindNamedSceneFormat(const SceneFormats& formats,
                                                const std::string& name);

/// One line per format, for help texts and messages.
std::string DescribeSceneFormats(const SceneFormats& formats);

/// The same with what can be done with each, and what it holds.
std::string TabulateSceneFormats(const SceneFormats& formats);

/// "NAME cannot hold 812 lines, 34 ratios: left out". Empty if it holds all
/// that the scene has.
std::string LossNote(const SceneFormat& format, const Scene& scene);

}  // namespace lowlap
