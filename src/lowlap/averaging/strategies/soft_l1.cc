#include "lowlap/averaging/strategies/internal/soft_l1.h"

#include "lowlap/averaging/strategies/internal/bounded_directions.h"

namespace lowlap {

Result<TranslationSolution> SoftL1Averager::Solve(
    const TranslationProblem& problem, const RunContext&) const {
  // OpenMVG's default.
  constexpr double kLossWidth = 0.01;
  return SolveDirectionParts(
      problem, [](const DirectionPart& part, int* num_iterations) {
        return MinimiseNarrowing(part, kLossWidth, num_iterations);
      });
}

}  // namespace lowlap
