#pragma once

#include "lowlap/features/internal/image.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// How the localisation error of a keypoint is shaped: the inverse of the
/// structure tensor sum g g^T of the gradients around it (Förstner & Gülch
/// 1987), over a window that follows its scale (standard deviation of the
/// blob), scaled such that the better direction has variance 1. A corner has
/// the identity; a blob on the grain of wood, or where an edge ends, is far
/// less certain along the edge. At most 100 (a tenfold deviation). The identity
/// where the image is flat.
Mat2 LocalizationCovariance(const GrayImage& image, const Vec2& position_px,
                            double scale_px);

}  // namespace lowlap
