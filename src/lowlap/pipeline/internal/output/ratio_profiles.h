#pragma once

#include <map>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/report/internal/report.h"
#include "lowlap/scale/evidence/evidence_kind.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Profiles of the scene's ratios (SketchScaleRatios), without the nodes of
/// flat stretches; none without kinds. They take time, so of more than 400
/// ratios they are those of the 200 with the least evidence, which a person
/// doubts first, and of an even choice of the others. Errors: those of
/// SketchScaleRatios.
Result<std::map<ViewTriplet, ReportProfile>> ProfilesForPage(
    const Scene& scene, const EvidenceKinds& kinds, const RunContext& context);

}  // namespace lowlap
