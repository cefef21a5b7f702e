#pragma once

#include <functional>
#include <optional>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// A solution of a problem without one of its ratios.
struct SolutionWithoutRatio {
  ViewTriplet ratio;
  TranslationSolution solution;
};

/// Looks for the ratio that is false where a loop does not close. Chance gives
/// a ratio of log10 NFA -n in one of 10^n triplets, and where it is all that
/// ties two groups of edges to one scale, averaging can only bend the loop
/// about it. What a solution costs is, over component 0,
///   sum log(1 + (angle / stddev)^2)    of the directions to the centres,
///   sum log(1 + (log error / stddev)^2)    of the ratios that it uses,
///   -log NFA    of the ratio that it does not use.
/// Of the solutions without one ratio that `agrees` accepts, that place as many
/// views in component 0 and cost less than `solution`, the cheapest; nullopt if
/// there is none. Tried are ratios without which two groups have no scale in
/// common (others averaging itself outvotes), at most 50, least evidence first.
/// Errors: those of the strategy.
Result<std::optional<SolutionWithoutRatio>> SolveWithoutContradictedRatio(
    const TranslationProblem& problem, const TranslationAverager& averager,
    const TranslationSolution& solution,
    const std::function<bool(const TranslationSolution&)>& agrees,
    const RunContext& context);

}  // namespace lowlap
