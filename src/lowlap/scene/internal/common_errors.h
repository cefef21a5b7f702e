#pragma once

namespace lowlap {

/// Errors of features that are closer than this share of the image's diagonal
/// have something in common: they lie in one texture, on one uneven wall, in
/// one corner of the lens. No number of them averages that out.
inline constexpr double kCommonErrorShare = 0.05;

}  // namespace lowlap
