#include "lowlap/pipeline/internal/decisions/compose_again.h"

#include <utility>

#include "lowlap/core/internal/propagate.h"

namespace lowlap {

Result<ComposedSolution> ComposeAgain(const MatchVerdicts& matches,
                                      ThirdViewVerdicts verdicts,
                                      SolveOptions options,
                                      const RunContext& context,
                                      StageLog* stages, Scene* scene) {
  options.reuse_ratios = true;
  ComposedSolution result;
  LOWLAP_ASSIGN_OR_RETURN(result.start.rotations,
                          AverageSceneRotations(*scene, options.poses, context,
                                                std::move(verdicts)));
  AddMatchVerdicts(matches, &result.start.rotations);
  LOWLAP_ASSIGN_OR_RETURN(
      result.ratios,
      EstimateBelievedRatios(scene, result.start, options, context, stages));
  LOWLAP_ASSIGN_OR_RETURN(
      result.poses, ComposePoses(scene, result.start.rotations, options.poses,
                                 context, stages));
  return result;
}

}  // namespace lowlap
