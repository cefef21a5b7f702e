#pragma once

#include "lowlap/pipeline/internal/output/summary_json.h"
#include "lowlap/report/internal/report.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What a run has to tell a person: figures, warnings, and tables of the scale
/// ratios, the pairs, the cameras' errors (if there is a truth) and the cost.
ReportContent MakeReport(const RunSummary& summary, const Scene& scene);

}  // namespace lowlap
