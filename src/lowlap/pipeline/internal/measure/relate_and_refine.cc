#include "lowlap/pipeline/internal/measure/relate_and_refine.h"

#include <string>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

// Whether the scene has other intrinsics now, as the first solution wants them.
Result<bool> TakeRefinedIntrinsics(const FirstSolution& first,
                                   const RunContext& context, StageLog* stages,
                                   Scene* scene) {
  if (!first.solve.adjust || !first.refinement.Any()) return false;
  SolveOptions options = first.solve;
  Scene refined = *scene;
  RefineAllIntrinsics(first.refinement, &refined, &options.adjustment);
  const auto solved = SolveScene(&refined, options, context, stages);
  if (!solved && solved.error().code == ErrorCode::kCancelled) {
    return tl::unexpected<Error>(solved.error());
  }
  constexpr double kLargeShiftPx = 1;
  if (!solved) {
    context.Log(LogLevel::kWarning, "intrinsics not refined before the rest: " +
                                        solved.error().ToString());
    return false;
  }
  if (LargestIntrinsicShiftPx(refined) <= kLargeShiftPx) return false;
  context.Log(LogLevel::kInfo,
              "relative poses once more, with refined intrinsics");
  for (const std::string& line : DescribeIntrinsicChanges(refined)) {
    context.Log(LogLevel::kInfo, line);
  }
  scene->intrinsics = refined.intrinsics;
  return true;
}

}  // namespace

Result<std::vector<PairReport>> RelateAndRefine(const RelateViews& relate,
                                                const FirstSolution& first,
                                                const RunContext& context,
                                                StageLog* stages,
                                                Scene* scene) {
  auto reports = relate(scene);
  if (!reports) return reports;
  LOWLAP_ASSIGN_OR_RETURN(const bool is_refined,
                          TakeRefinedIntrinsics(first, context, stages, scene));
  return is_refined ? relate(scene) : reports;
}

}  // namespace lowlap
