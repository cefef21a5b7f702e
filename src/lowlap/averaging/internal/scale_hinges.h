#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/diagnosis.h"

namespace lowlap {

/// The cameras that scale groups hinge on, by camera, from the groups by
/// directions and by ratios of `diagnosis`.
std::vector<ScaleHinge> FindScaleHinges(const Scene& scene,
                                        const Diagnosis& diagnosis,
                                        const DiagnosisOptions& options);

/// Most meaningful first.
void SortByEvidence(const Scene& scene, std::vector<std::size_t>* ratios);

ViewPair OrderedPair(ViewId a, ViewId b);

}  // namespace lowlap
