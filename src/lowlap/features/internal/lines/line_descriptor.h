#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Line band descriptor (Zhang & Koch 2013), binary form: 256 bits, compared
/// by the Hamming distance.
using LineDescriptor = std::array<std::uint8_t, 32>;

/// Raised whenever descriptors change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kLineDescriptorVersion = 1;

/// One descriptor per segment, in order.
Result<std::vector<LineDescriptor>> DescribeLines(
    const GrayImage& image, const std::vector<LineSegment>& segments);

}  // namespace lowlap
