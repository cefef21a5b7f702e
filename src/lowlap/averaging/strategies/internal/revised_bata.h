#pragma once

#include <vector>

#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// A number of iterations, as for revised LUD.
using RevisedBataOptions = RevisedLudOptions;

/// The objective of BATA (SolveBata: Zhuang, Cheong, Lee 2018; Huber's loss
/// of the sine of the angle between C_j - C_i and d_ij) at its minimum: the
/// inverse lengths are eliminated, and Levenberg-Marquardt runs over the
/// centres until the objective stands still, instead of a hundred steps of
/// block coordinate descent. This is how global mappers minimise it (Pan,
/// Barath, Pollefeys, Schonberger, "Global structure-from-motion revisited",
/// ECCV 2024, on directions between cameras). The start is revised LUD.
///
/// It is not the rotation-assisted variant of the paper, which weighs an edge
/// down also where its relative rotation disagrees with the averaged ones: no
/// relative rotation is part of a TranslationProblem, and edges that disagree
/// are left out before. A lower objective is not always a smaller error: within
/// 6 degrees the loss is quadratic in the angle, so that the minimum follows
/// short baselines, whose directions are the least certain, as much as long
/// ones, while descent that stops early stays closer to revised LUD, which does
/// not. Where such edges matter, SolveBata comes out better.
///
/// Not convex: a start that is wrong may stay wrong. Adds to `num_iterations`;
/// kNumerical if a factorisation fails; kCancelled.
Result<std::vector<Vec3>> SolveRevisedBata(const DirectionPart& part,
                                           const RevisedBataOptions& options,
                                           const RunContext& context,
                                           int* num_iterations);

}  // namespace lowlap
