#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/rigidity/internal/diagnosis.h"

namespace lowlap {

/// The cameras that scale groups articulation on, by camera, from the groups by
/// directions and by ratios of `diagnosis`.
std::vector<ScaleArticulation> FindScaleArticulations(
    const std::vector<ScaleRatio>& ratios, const ScaleDiagnosis& diagnosis,
    const DiagnosisOptions& options);

/// Most meaningful first.
void SortByEvidence(const std::vector<ScaleRatio>& ratios,
                    std::vector<std::size_t>* indices);

}  // namespace lowlap
