#include "lowlap/averaging/strategies/internal/revised_lud.h"

#include "lowlap/averaging/strategies/internal/angle_objective.h"

namespace lowlap {

Result<TranslationSolution> RevisedLudAverager::Solve(
    const TranslationProblem& problem, const RunContext&) const {
  return SolveDirectionParts(problem, SolveRevisedLud);
}

}  // namespace lowlap
