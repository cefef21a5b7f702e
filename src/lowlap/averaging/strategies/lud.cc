#include "lowlap/averaging/strategies/internal/lud.h"

#include "lowlap/averaging/strategies/internal/bounded_directions.h"

namespace lowlap {

Result<TranslationSolution> LudAverager::Solve(
    const TranslationProblem& problem, const RunContext&) const {
  constexpr double kDelta = 1e-6;
  return SolveDirectionParts(
      problem, [](const DirectionPart& part, int* num_iterations) {
        return MinimiseNarrowing(part, kDelta, num_iterations);
      });
}

}  // namespace lowlap
