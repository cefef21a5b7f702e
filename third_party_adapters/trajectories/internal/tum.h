#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"

namespace lowlap::trajectories {

// The trajectories of the TUM RGB-D benchmark: lines
//   timestamp tx ty tz qx qy qz qw
// with the camera centre and the rotation world from camera, in our axes, and
// comments after #. A view is called by its timestamp, as it is written. Where
// all timestamps are whole numbers, they are the ids of the views, otherwise
// the places in the file are.

/// Whether the first line that is no comment is one of eight numbers.
bool IsTumStart(std::string_view start);

/// Errors, with file and line: kParse for a line of anything but eight numbers,
/// a quaternion that is not of length 1, a timestamp that is repeated, and a
/// file without a pose.
Result<Scene> ParseTum(std::string_view text, const std::string& file);

/// The posed views. Timestamps are the file names without extension, if they
/// all are numbers and differ, else the ids of the views, and `notes` says so.
Result<std::string> FormatTum(const Scene& scene, SceneNotes* notes);

}  // namespace lowlap::trajectories
