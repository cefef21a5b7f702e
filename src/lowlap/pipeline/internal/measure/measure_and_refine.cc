#include "lowlap/pipeline/internal/measure/measure_and_refine.h"

#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/measure/image_measurements.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"

namespace lowlap {

Result<ImageReport> MeasureAndRefine(Scene* scene,
                                     const MeasurementOptions& options,
                                     const FirstSolution& first,
                                     const RunContext& context,
                                     StageLog* stages) {
  LOWLAP_ASSIGN_OR_RETURN(auto measurements,
                          MatchImages(*scene, options, context, stages));
  const auto relate = [&](Scene* related) {
    return RelatePairs(measurements, options, context, stages, related);
  };
  ImageReport report;
  LOWLAP_ASSIGN_OR_RETURN(
      report.pairs, RelateAndRefine(relate, first, context, stages, scene));
  report.unrelated =
      FindUnrelatedViews(scene->views, report.pairs, measurements.failed);
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
