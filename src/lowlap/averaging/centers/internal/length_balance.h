#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// Per edge of the problem, what the ratios say of its length between the
/// centres of component 0: the evidence (EvidenceOfNfa) of those to edges that
/// `is_believed` marks and that agree with the centres, less that of those that
/// do not. An error of a length is one of a direction, along it and not across:
/// ratios agree within the limit of a direction of their deviation. 0 for what
/// is not placed. Cost: one pass over the ratios.
std::vector<double> LengthBalance(const TranslationProblem& problem,
                                  const TranslationSolution& solution,
                                  const ErrorLimits& limits,
                                  const std::vector<char>& is_believed);

/// The edges of component 0 whose directions agree with the centres, and whose
/// lengths do not: along a street of equal windows one for another shortens a
/// baseline and turns none. One after the other, the edge of least balance, if
/// that is negative, is believed no more, and says nothing of those that
/// remain. Directions agree within the limit for residuals of `sigma_rad`.
/// Cost: a pass over the ratios for every one that is found.
std::vector<std::size_t> ContradictedLengths(
    const TranslationProblem& problem, const TranslationSolution& solution,
    const ErrorLimits& limits, double sigma_rad);

}  // namespace lowlap
