#include "lowlap/averaging/strategies/internal/bounded_lengths.h"

#include <cmath>

#include "lowlap/averaging/strategies/internal/bounded_directions.h"

namespace lowlap {

BoundedLengthsOptions BoundedLengthsOptions::L2Chordal() {
  return {HUGE_VAL, 100};
}
// The width is OpenMVG's default.
BoundedLengthsOptions BoundedLengthsOptions::SoftL1() { return {0.01, 300}; }
BoundedLengthsOptions BoundedLengthsOptions::Lud() { return {1e-6, 300}; }

Status BoundedLengthsOptions::Validate() const {
  if (loss_width > 0 && max_iterations > 0) return {};
  return MakeError(ErrorCode::kInvalidArgument,
                   "the width of the loss and the number of iterations must be "
                   "positive");
}

Result<TranslationSolution> BoundedLengthsAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  if (const Status valid = options_.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  return SolveDirectionParts(
      problem, context,
      [&](const DirectionPart& part, const RunContext& of_part,
          int* num_iterations) {
        return MinimiseNarrowing(part, options_.loss_width,
                                 options_.max_iterations, of_part,
                                 num_iterations);
      });
}

}  // namespace lowlap
