#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/features/image.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Line band descriptor (Zhang & Koch 2013), binary form: 256 bits, compared
/// by the Hamming distance.
using LineDescriptor = std::array<std::uint8_t, 32>;

/// One descriptor per segment, in order.
Result<std::vector<LineDescriptor>> DescribeLines(
    const GrayImage& image, const std::vector<LineSegment>& segments);

}  // namespace lowlap
