#pragma once

#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// One residual of a coplanar pair: a view, and the indices of the line that
/// the meeting point is taken on and of the line it is compared with.
struct PairTerm {
  int view = -1;
  int on = -1;
  int to = -1;
};

/// The residuals of a pair, one kind or the other. kTransfer: for every view of
/// each line; kImageDistance: for every view of both (none if no view sees
/// both).
std::vector<PairTerm> PairTerms(const StructureState& state,
                                const PairState& pair,
                                AdjustedCoplanarResidual residual);

/// Root mean square of the pair's residuals, in pixels; infinity without any.
double PairErrorPx(const CameraSet& cameras, const StructureState& state,
                   const PairState& pair, AdjustedCoplanarResidual residual);

}  // namespace lowlap
