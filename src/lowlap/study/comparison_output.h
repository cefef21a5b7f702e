#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"
#include "lowlap/study/compare_strategies.h"

namespace lowlap {

/// A table for people, a row per strategy, and below it why cameras are
/// missing. Position errors are in the truth's unit, or, without a truth,
/// differences to the reference strategy in mean baselines.
std::string ToText(const Comparison& comparison);

/// One record per strategy. Cells of what there is not are empty. The columns
/// whose names end in "_s" are times and differ from run to run; they are the
/// last ones. All others are the same in every run.
std::string ToCsv(const Comparison& comparison);

/// The members of Comparison; times are in objects named "cost".
std::string ToJson(const Comparison& comparison, const Scene& scene);

/// Plots as SVG documents with their file names: position errors before and
/// after adjustment (with a truth; else the differences to the reference),
/// cameras placed, how well the relative poses and ratios are met, times.
Result<std::vector<std::pair<std::string, std::string>>> DrawComparison(
    const Comparison& comparison);

/// Makes the folder and writes compare.csv, compare.json and the plots into it,
/// each whole or not at all.
Status WriteComparison(const Comparison& comparison, const Scene& scene,
                       const std::string& folder);

}  // namespace lowlap
