#pragma once

#include <algorithm>

namespace lowlap {

/// Pixels of an image of diagonal d in a pixel of the estimation,
/// max(1, d / 3700): what is looked for within a few pixels is blurred by as
/// many more, and calibrated as much worse, in an image of more than 6
/// megapixels.
inline double PixelUnit(double image_diagonal_px) {
  constexpr double kUsualDiagonalPx = 3700;
  return std::max(1.0, image_diagonal_px / kUsualDiagonalPx);
}

}  // namespace lowlap
