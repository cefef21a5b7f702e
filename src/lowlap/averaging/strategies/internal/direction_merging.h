#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// One label per edge: equal for edges whose relative lengths the directions
/// fix. The rules are those of FindDirectionParts. kCancelled.
Result<std::vector<std::size_t>> LabelRigidEdges(
    const TranslationProblem& problem, const RunContext& context);

}  // namespace lowlap
