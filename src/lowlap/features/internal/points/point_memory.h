#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// SIFT's pyramid: 4 times the pixels, 11 images of 4 bytes, octaves 4/3.
inline constexpr double kPointBytesPerPixel = 240;

/// kUnsupported if the points of an image of this size take more memory than
/// the machine has, or than the process may take.
Status CheckMemoryOfPoints(int width_px, int height_px,
                           const std::string& path);

/// The context with as many threads as may detect points in images of so many
/// pixels at once, at least one.
RunContext WithinPointMemory(const RunContext& context, double pixels,
                             double max_memory_gb);

}  // namespace lowlap
