#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap::colmap {

/// A camera as COLMAP's files and databases hold it. Its pixels have the corner
/// of the image at (0, 0), ours the centre of the first pixel.
struct Camera {
  std::uint32_t id = 0;
  int model = 0;  // COLMAP's number of it
  std::uint64_t width_px = 0;
  std::uint64_t height_px = 0;
  std::vector<double> params;
};

/// COLMAP's name of a model ("PINHOLE", ...), and back; the number of its
/// parameters. nullptr and nullopt for what is not known.
const char* ModelName(int model);
std::optional<int> ModelFromName(const std::string& name);
std::optional<std::size_t> ParameterCount(int model);

/// The same camera, exactly. kUnsupported, with camera and model, where no
/// model of ours projects alike; kInvalidScene for numbers that are no camera.
Result<Intrinsic> ToIntrinsic(const Camera& camera);

/// The same camera in the simplest model of COLMAP that holds it exactly.
/// kUnsupported: a panorama that is not twice as wide as high.
Result<Camera> FromIntrinsic(const Intrinsic& intrinsic, std::uint32_t id);

/// A pixel of COLMAP minus the same pixel of ours: half a pixel, but nothing in
/// panoramas, where both programs put the middle of the image at width / 2.
Vec2 PixelShift(const Intrinsic& intrinsic);

}  // namespace lowlap::colmap
