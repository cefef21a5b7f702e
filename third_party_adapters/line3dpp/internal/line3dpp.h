#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"

namespace lowlap::line3dpp {

// The result of Line3D++ as text: a line of text per 3D line,
//   number of pieces, each as X1 X2 (6 numbers),
//   number of segments, each as image, segment, x1 y1 x2 y2.
// The segments are in undistorted images. There are neither cameras nor names.

/// Whether the first line is one of these.
bool IsLine3dppStart(std::string_view start);

/// The pieces of a line become one, from end to end, and `notes` says so; see
/// AddFileLines for the rest. Errors with the file: kParse with the line for
/// text that is malformed or ends early and for a line without length.
Result<Scene> ParseLine3dpp(std::string_view text, const std::string& file,
                            SceneNotes* notes);

/// The lines of the undistorted scene (UndistortedScene).
Result<std::string> FormatLine3dpp(const Scene& scene, SceneNotes* notes);

}  // namespace lowlap::line3dpp
