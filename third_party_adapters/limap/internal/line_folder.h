#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"

namespace lowlap {
class FileSet;
}

namespace lowlap::limap {

/// A folder of LIMAP (folder_layout.h): views from the model or image_list.txt,
/// segments, lines as structure and tracks (AddFileLines), and matches of
/// segments as inliers of the relative poses of views that the model poses;
/// others are left out and noted. Segments count as those of undistorted images
/// of the size that the model has, and pixels from the centre of the first one,
/// as the detector LSD does.
///
/// Errors with file and line: kParse for text that is malformed or ends early,
/// kInvalidScene for segments that are not there, kUnsupported for several
/// detectors or matchers, and those of COLMAP's models.
Result<Scene> ReadLineFolder(const std::string& folder, SceneNotes* notes);

/// The undistorted scene (UndistortedScene) as such a folder; ids are those of
/// the COLMAP model in it. kInvalidArgument where files of another scene would
/// be left among ours.
Result<SceneNotes> WriteLineFolder(const Scene& scene,
                                   const std::string& folder, FileSet* files);

}  // namespace lowlap::limap
