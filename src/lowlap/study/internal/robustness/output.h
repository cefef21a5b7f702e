#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/study/internal/robustness/study.h"

namespace lowlap {

/// The plots of a scenario as (file name, SVG): ID_right.svg (share of views
/// placed right against the value), ID_error.svg (median error) and, where the
/// value is the number of views, ID_time.svg.
Result<std::vector<std::pair<std::string, std::string>>> DrawScenario(
    const RobustnessStudy& study, std::size_t scenario);

/// A page with all plots, which lie beside it, and the breakdown table.
std::string IndexHtml(const RobustnessStudy& study);

/// Writes what a study that is complete leaves: trials.csv, curves.csv,
/// summary.txt, index.html and all plots.
Status WriteRobustness(const RobustnessStudy& study, const std::string& folder);

}  // namespace lowlap
