#pragma once

#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// How far the image of a viewing ray moves from one camera to another, in
/// pixels: the largest value over the corners and the middles of the sides, of
/// those that have a ray (Intrinsic::Bearing).
double IntrinsicShiftPx(const Intrinsic& from, const Intrinsic& to);

}  // namespace lowlap
