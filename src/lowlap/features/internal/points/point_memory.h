#pragma once

#include <string>

#include "lowlap/core/result.h"

namespace lowlap {

/// SIFT's pyramid: 4 times the pixels, 11 images of 4 bytes, octaves 4/3.
inline constexpr double kPointBytesPerPixel = 240;

/// kUnsupported if the points of an image of this size take more memory than
/// the machine has, or than the process may take.
Status CheckMemoryOfPoints(int width_px, int height_px,
                           const std::string& path);

}  // namespace lowlap
