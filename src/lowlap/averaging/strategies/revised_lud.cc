#include "lowlap/averaging/strategies/internal/revised_lud.h"

#include "lowlap/averaging/strategies/internal/angle_objective.h"

namespace lowlap {

Status RevisedLudOptions::Validate() const {
  if (max_iterations > 0) return {};
  return MakeError(ErrorCode::kInvalidArgument,
                   "the number of iterations must be positive");
}

Result<TranslationSolution> RevisedLudAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  if (const Status valid = options_.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  return SolveDirectionParts(
      problem, context,
      [&](const DirectionPart& part, const RunContext& of_part,
          int* num_iterations) {
        return SolveRevisedLud(part, options_.max_iterations, of_part,
                               num_iterations);
      });
}

}  // namespace lowlap
