#pragma once

#include <vector>

#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "lowlap/matching/internal/repeats/conjugate_translation.h"

namespace lowlap {

/// For each point of one photograph, whether one of the translations, either
/// way, takes it to one of nearly the same size that looks like it. A small or
/// a foreshortened copy need not be the nearest of its part of the photograph
/// (FindAlikePlaces); here it is only held against chance: with c points where
/// the translations lead and s the share of the photograph's points that look
/// at least as much alike, the expected number of accidental copies, c s, must
/// be below 1/20. s is measured on an even sample of 500 points. None for
/// points at infinity. O(n (t log n + 500)), n points and t translations.
std::vector<bool> FindCopiedPoints(
    const PointView& view,
    const std::vector<ConjugateTranslation>& translations);

}  // namespace lowlap
