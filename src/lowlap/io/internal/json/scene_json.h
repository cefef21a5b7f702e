#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The text form of a scene: OpenMVG's sfm_data.json (versions 0.1, 0.2 and
/// 0.3 are read, 0.3 is written) with one more top-level key, "lowlap", which
/// OpenMVG's reader skips. sfm_data/FORMAT.md is the specification.
///
/// Numbers are written with the digits that restore them exactly:
/// reading what was written gives an equal scene.
///
/// Errors of reading carry the file and, as `place`, "line L, column C" for
/// malformed text or the JSON path of the offending value:
///   kNotFound, kIo   the file cannot be read
///   kParse           malformed text; missing or repeated key; wrong type;
///                    number out of range; NaN or Infinity
///   kUnsupported     unknown version, unknown camera model
///   kInvalidScene    the content contradicts itself (ValidateScene)
Result<Scene> ReadSceneJson(const std::string& path);

/// The same from memory; `file` only names the origin in errors.
Result<Scene> ParseSceneJson(const std::string& text,
                             const std::string& file = {});

/// Error: kInvalidScene, of ValidateScene.
Result<std::string> FormatSceneJson(const Scene& scene);

}  // namespace lowlap
