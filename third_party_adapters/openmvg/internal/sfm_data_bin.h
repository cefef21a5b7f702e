#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap::openmvg {

/// OpenMVG's `sfm_data.bin` (cereal's PortableBinary archive), versions 0.1 to
/// 0.3: a byte that tells the endianness (1: little, 0: big), the version, the
/// root path, views, intrinsics, extrinsics, structure and control points.
///
/// Every length is checked against the bytes that are left before anything is
/// allocated. Errors, with the byte offset as `place`: kParse for anything
/// truncated or malformed (null pointers and numbers that are not finite among
/// it), kInvalidScene for repeated ids, kUnsupported for an unknown version or
/// camera model; then those of ValidateScene. Bytes after the last item are
/// ignored, as OpenMVG does.
Result<Scene> ReadSfmDataBin(const std::string& path);

/// The same from memory, without ValidateScene; `file` is for messages only.
Result<Scene> ParseSfmDataBin(std::string_view bytes,
                              const std::string& file = {});

/// The bytes of a scene as it is, little-endian, version 0.3, every map in the
/// order of its ids. Only fx_px of an intrinsic fits into the format.
std::string SerializeSfmDataBin(const Scene& scene);

}  // namespace lowlap::openmvg
