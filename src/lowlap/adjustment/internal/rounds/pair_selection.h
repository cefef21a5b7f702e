#pragma once

#include <cstddef>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// Decides which pairs have residuals in the next solve, and returns for how
/// many that changed.
///
/// A pair in use was free to bend its lines within their noise: it stays if its
/// residual is within the threshold, and else is inconsistent. One out of use
/// is consistent if noise explains its gap (PairGap) and, if `take_new`, is
/// taken into use, those that can be judged best first, while both of its lines
/// have less than max_pairs_per_line pairs. Only pairs with a line of two views
/// are taken: where both lines are determined by three, they say what the lines
/// say themselves, and cost the solver's matrix its sparsity.
std::size_t SelectPairs(const AdjustmentOptions& options,
                        const CameraSet& cameras, double threshold_px,
                        bool take_new, StructureState* state);

}  // namespace lowlap
