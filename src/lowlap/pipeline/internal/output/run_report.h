#pragma once

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/report/internal/report.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What a run has to show a person: figures, warnings, photographs, pairs,
/// profiles of the ratios, the solution before its adjustment, and the truth.
/// Errors: those of PagePhotographs and ProfilesForPage.
Result<ReportContent> MakeReport(const RunSummary& summary, const Scene& scene,
                                 const RunContext& context);

}  // namespace lowlap
