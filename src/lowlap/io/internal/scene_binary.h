#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The binary form of a scene, `.lowlap`: the same content as the text form,
/// little-endian, in sections that each carry their length and a CRC-32.
/// sfm_data/FORMAT.md is the specification.
///
/// Every length is checked against the bytes that are left before anything is
/// allocated, so a damaged file is an error, never a crash. Errors carry the
/// file and, as `place`, the section and byte offset, or the JSON path of the
/// offending value:
///   kNotFound, kIo   the file cannot be read
///   kParse           not such a file; truncated; damaged
///   kUnsupported     unknown version
///   kInvalidScene    the content contradicts itself (ValidateScene)
Result<Scene> ReadSceneBinary(const std::string& path);

/// The same from memory; `file` only names the origin in errors.
Result<Scene> ParseSceneBinary(const std::string& bytes,
                               const std::string& file = {});

/// Error: kInvalidScene, of ValidateScene.
Result<std::string> FormatSceneBinary(const Scene& scene);

}  // namespace lowlap
