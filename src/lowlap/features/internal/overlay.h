#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Writes the image as a PNG, faded, with its points as dots and its segments
/// as lines: each in a colour of its own, so that pieces of a broken edge can
/// be told apart, with a dot at its end (the direction is the polarity).
/// Errors: kIo, with the path.
Status WriteOverlay(const GrayImage& image, const ViewFeatures& features,
                    const std::string& path);

}  // namespace lowlap
