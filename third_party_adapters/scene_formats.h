#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

class FileSet;

/// Every scene format there is: OwnSceneFormats and those of the adapters, in
/// the order in which they are tried. `lowlap convert --formats` lists them.
SceneFormats AllSceneFormats();

/// Whether a file or folder is there and of one of these formats, by which
/// ReadScene would take it; it may be damaged all the same.
bool IsScene(const std::string& path);

/// Reads a scene file or folder, in the format called `format` if it is given.
/// Otherwise a file is told by its first bytes, where these tell, so that a
/// wrong extension does no harm, then by the extension. kUnsupported, with the
/// list of formats, for anything else. What the reader leaves out is added to
/// `notes`, which may be null.
Result<Scene> ReadScene(const std::string& path, SceneNotes* notes = nullptr,
                        const std::string& format = {});

/// Whether WriteScene could write there, as far as that shows before there is a
/// scene: the format must be one that is written, and a database to write into
/// must exist. For asking before long work.
Status CheckScenePlace(const std::string& path, const std::string& format = {});

/// Writes a scene in the format of the extension, or in the one called `format`
/// if it is given; with `files`, as one of them. Returns notes: what the format
/// does not hold, counted (LossNote), and what else it changed. kUnsupported,
/// with the list of formats, for an unknown one.
Result<SceneNotes> WriteScene(const Scene& scene, const std::string& path,
                              const std::string& format = {});
Result<SceneNotes> WriteScene(const Scene& scene, const std::string& path,
                              const std::string& format, FileSet* files);

}  // namespace lowlap
