#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"

namespace lowlap::trajectories {

// The poses of the KITTI odometry benchmark: a line per camera, with the three
// rows of [R^T | C], world from camera, in our axes. There are neither names
// nor numbers: line n, from 0, is view n, which has no name; other programs'
// views are found by that id. A file has no place for a view without a pose.

/// Whether the first line is one of twelve numbers.
bool IsKittiStart(std::string_view start);

/// Errors, with file and line: kParse for a line of anything but twelve numbers
/// for a matrix that is no rotation, and for a file without a pose.
Result<Scene> ParseKitti(std::string_view text, const std::string& file);

/// The posed views in the order of their ids; `notes` warns where a line is not
/// the id of its view.
Result<std::string> FormatKitti(const Scene& scene, SceneNotes* notes);

}  // namespace lowlap::trajectories
