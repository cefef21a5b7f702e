#pragma once

#include <string>
#include <vector>

#include "lowlap/averaging/rigidity/internal/rigidity.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The content of summary.json. Times and memory are in "cost", apart from
/// everything that is the same in every run. What the command did not do has no
/// entry; what there is nothing to compute from is null.
std::string ToJson(const RunSummary& summary, const Scene& scene);

/// The ratios as JSON: one object per triplet.
std::string ToJson(const std::vector<ScaleRatio>& ratios);

std::string ToJson(const RigidityReport& report);

}  // namespace lowlap
