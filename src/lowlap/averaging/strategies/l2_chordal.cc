#include "lowlap/averaging/strategies/internal/l2_chordal.h"

#include <cmath>

#include "lowlap/averaging/strategies/internal/bounded_directions.h"

namespace lowlap {

Result<TranslationSolution> L2ChordalAverager::Solve(
    const TranslationProblem& problem, const RunContext&) const {
  constexpr int kMaxIterations = 100;
  return SolveDirectionParts(
      problem,
      [](const DirectionPart& part,
         int* num_iterations) -> Result<std::vector<Vec3>> {
        std::vector<Vec3> centers;
        const auto iterations =
            MinimiseBounded(part, HUGE_VAL, kMaxIterations, &centers);
        if (!iterations) return tl::unexpected<Error>(iterations.error());
        *num_iterations += *iterations;
        return centers;
      });
}

}  // namespace lowlap
