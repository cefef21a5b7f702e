#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/types.h"

namespace lowlap::openmvg {

/// The pixel positions of a `.feat` file: one feature a line, x and y first;
/// 2 numbers a line (points), 4 (scale, orientation) or 8 (affine), the same on
/// every line. The index in the result is the feature index of match files and
/// observations. Pixels are raw (distorted); the centre of the top-left pixel
/// is (0, 0). An empty file has no features. Errors: kParse with the line.
Result<std::vector<Vec2>> ReadFeat(const std::string& path);
Result<std::vector<Vec2>> ParseFeat(std::string_view text,
                                    const std::string& file = {});

}  // namespace lowlap::openmvg
