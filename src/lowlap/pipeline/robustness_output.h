#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/pipeline/robustness_study.h"

namespace lowlap {

/// One line per trial and strategy: scenario, world, value, seed, strategy,
/// views, placed, right, median_error (empty if infinite), note.
std::string TrialsCsv(const RobustnessStudy& study);

/// One line per scenario, value and strategy: the mean share of views that are
/// placed, and placed right, over the seeds, the median of the median errors
/// (empty if infinite), and the note of the first trial that has one.
std::string CurvesCsv(const RobustnessStudy& study);

/// Writes trials.csv, curves.csv, and for each scenario NAME_WORLD_right.svg
/// (share of views placed right against the value) and NAME_WORLD_error.svg
/// (median error) into the folder, which must exist.
Status WriteRobustness(const RobustnessStudy& study, const std::string& folder);

}  // namespace lowlap
