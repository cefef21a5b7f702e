#include "lowlap/pipeline/internal/measure/measure_and_refine.h"

#include <string>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/measure/image_measurements.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"

namespace lowlap {
namespace {

// Whether the scene has other intrinsics now, as a first solution wants them.
Result<bool> TakeRefinedIntrinsics(SolveOptions options,
                                   const IntrinsicRefinement& refinement,
                                   const RunContext& context, StageLog* stages,
                                   Scene* scene) {
  if (!options.adjust || !refinement.Any()) return false;
  Scene first = *scene;
  RefineAllIntrinsics(refinement, &first, &options.adjustment);
  const auto solved = SolveScene(&first, options, context, stages);
  if (!solved && solved.error().code == ErrorCode::kCancelled) {
    return tl::unexpected<Error>(solved.error());
  }
  constexpr double kLargeShiftPx = 1;
  if (!solved || LargestIntrinsicShiftPx(first) <= kLargeShiftPx) return false;
  context.Log(LogLevel::kInfo,
              "relative poses once more, with refined intrinsics");
  for (const std::string& line : DescribeIntrinsicChanges(first)) {
    context.Log(LogLevel::kInfo, line);
  }
  scene->intrinsics = first.intrinsics;
  scene->given_intrinsics = first.given_intrinsics;
  return true;
}

}  // namespace

Result<ImageReport> MeasureAndRefine(Scene* scene,
                                     const MeasurementOptions& options,
                                     const SolveOptions& solve,
                                     const IntrinsicRefinement& refinement,
                                     const RunContext& context,
                                     StageLog* stages) {
  LOWLAP_ASSIGN_OR_RETURN(auto measurements,
                          MatchImages(*scene, options, context, stages));
  ImageReport report;
  LOWLAP_ASSIGN_OR_RETURN(
      report.pairs, RelatePairs(measurements, options, context, stages, scene));
  LOWLAP_ASSIGN_OR_RETURN(
      const bool refined,
      TakeRefinedIntrinsics(solve, refinement, context, stages, scene));
  if (refined) {
    LOWLAP_ASSIGN_OR_RETURN(report.pairs, RelatePairs(measurements, options,
                                                      context, stages, scene));
  }
  report.unrelated = FindUnrelatedViews(report.pairs, measurements.failed);
  for (const UnrelatedView& view : report.unrelated) {
    context.Log(
        LogLevel::kWarning,
        scene->NameOf(view.view) + " has no relative pose: " + view.reason);
  }
  if (scene->relative_poses.empty()) {
    return MakeError(ErrorCode::kInsufficientData, ExplainNoPose(report.pairs));
  }
  for (auto& [view, features] : measurements.features) {
    report.detected[view] = std::move(features.features);
  }
  return report;
}

}  // namespace lowlap
