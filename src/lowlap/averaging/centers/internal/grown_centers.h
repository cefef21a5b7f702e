#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// The relative poses that contradict centres that grow by evidence, one view
/// after the other, as incremental reconstruction places them: a start that no
/// false relative pose bends before right ones outvote it, for those that many
/// false ones bend together.
///
/// It begins with a ratio. A view may be placed where a ratio of one of its
/// relative poses to one between placed views puts it. For the place speak the
/// relative poses to placed views whose directions agree with it, within
/// `limits`, and whose ratios agree by evidence, too; the others speak against
/// it. Of its places a view takes the one with the most evidence for it less
/// that against it, and of the views that comes next for whose place most
/// speaks, whatever speaks against it: weak links wait. Where no ratio leads
/// on, the strongest among the views that are left begins another part; a ratio
/// is as strong as its weakest part, either relative pose or itself.
///
/// So it begins with each of the `max_starts` strongest ratios, and the centres
/// count that agree with relative poses of the most evidence: of many things
/// that look alike, some may well have the strongest.
///
/// What joins parts is not judged. `evidence` holds every edge of `problem`.
/// Cost of a start: for each view placed, ten places each for the views near
/// it, times the ratios of their relative poses.
std::vector<ViewPair> ContradictionsOfGrowth(const TranslationProblem& problem,
                                             const EvidenceOfPairs& evidence,
                                             const ErrorLimits& limits,
                                             std::size_t max_starts);

}  // namespace lowlap
