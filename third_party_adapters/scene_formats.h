#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

class FileSet;

/// Every scene format there is: OwnSceneFormats and those of the adapters,
///   openmvg-json  -        what OpenMVG holds and nothing else
///   openmvg-bin   .bin     what OpenMVG holds
///   openmvg-xml   .xml     what OpenMVG holds
///   1dsfm         folder   a problem of 1DSfM; read only
///   colmap-bin    folder   a model of COLMAP
///   colmap        folder   the same as text
///   colmap-db     .db      a database of COLMAP; written into one there is,
///                          at once and not as one of the files of a set
SceneFormats AllSceneFormats();

/// Whether a file or folder is there and of one of these formats, by which
/// ReadScene would take it; it may be damaged all the same.
bool IsScene(const std::string& path);

/// Reads a scene file or folder. An sfm_data file is told by its first bytes,
/// so that a wrong extension does no harm; other files by the extension.
/// kUnsupported, with the list of formats, for anything else. What the reader
/// leaves out is added to `notes`, which may be null.
Result<Scene> ReadScene(const std::string& path, SceneNotes* notes = nullptr);

/// Writes a scene in the format of the extension, or in the one called `format`
/// if it is given; with `files`, as one of them. Returns notes on what the
/// format cannot hold. kUnsupported, with the list of formats, for an unknown
/// one.
Result<SceneNotes> WriteScene(const Scene& scene, const std::string& path,
                              const std::string& format = {});
Result<SceneNotes> WriteScene(const Scene& scene, const std::string& path,
                              const std::string& format, FileSet* files);

}  // namespace lowlap
