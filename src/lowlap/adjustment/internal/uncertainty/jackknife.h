#pragma once

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/adjustment/internal/uncertainty/center_covariances.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Adds to `uncertainty` what the centres owe to the one or the other part of
/// the scene: a jackknife that deletes groups.
///
/// A wall bows, a shelf is taken for one wall, the tracks of a pair bear out
/// its false pose. Such errors are common to neighbours, and do not average out
/// as noise does. So the landmarks of each component are divided by where they
/// are into patches, of as many landmarks each, and the patches into groups
/// that are spread over the scene. Without one group at a time, what is left in
/// use is solved again from the adjusted state. With the steps d_g of the
/// centres (CenterShift), from G groups,
///   C += (G - 1) / G sum_g d_g d_g^T,
/// and the variances of log ratios and directions likewise. Noise is counted
/// twice with it, which makes up for G being small.
///
/// Where most observations are of landmarks that more views see (not
/// MostAreSeenTwice), these check each other, and nothing is added.
///
/// Relative poses and scale ratios are left out, as in
/// EstimateCenterUncertainty. A group without which there is no solution has no
/// part; what falls apart without a group is not moved by it. On the context's
/// threads. Error: kCancelled.
Status AddJackknife(const AdjustmentOptions& options, const NoiseLevels& noise,
                    const RunContext& context, const CameraSet& cameras,
                    StructureState state, CenterUncertainty* uncertainty);

}  // namespace lowlap
