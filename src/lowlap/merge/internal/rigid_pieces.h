#pragma once

#include <map>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/merge/merge_models.h"

namespace lowlap {

/// The rigid pieces of cameras, by the relative poses that agree with them and
/// by all ratios between these; see CheckModel.
///
/// With the deviations s = limit / reach of directions and ratios, what agrees
/// has to first order in the centres the information
///   H = sum_e (I - u u^T) / (L s)^2 + sum_r g g^T / s^2 + I / (10^2 sum |X|^2)
/// (u, L: direction and length of a baseline, g: gradient of a log ratio; the
/// last term leaves what nothing fixes with a deviation of more than a factor
/// of two). It fixes a log ratio if g^T H^-1 g is below a tenth squared: then
/// the two baselines belong together. A ratio that was measured says so with
/// the evidence
///   (1 + log(1 - log10 NFA)) max(-1, 1 - 2 (error / limit)^2),
/// for or against. One that only follows, from directions mostly, has the
/// evidence 1, shared by all that follow of one baseline at one view: these are
/// one statement. A baseline that is nearly straight on from two others fixes
/// nothing, however well it agrees; where it still seems to, the ratios
/// overrule it. What is fixed by what agrees between the middle view of two
/// baselines and its neighbours alone is fixed; all is asked of the rest only.
/// Pieces are what these links hold together, see PiecesOfLinks.
///
/// Most views first, of three views at least. Errors: kCancelled; kNumerical if
/// the equations cannot be solved.
Result<std::vector<RigidPiece>> FindRigidPieces(
    const std::map<ViewId, Pose>& poses,
    const std::vector<PairAgreement>& pairs,
    const std::vector<RatioAgreement>& ratios, double reach,
    const RunContext& context);

}  // namespace lowlap
