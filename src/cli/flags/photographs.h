#pragma once

#include <string>
#include <vector>

#include "cli/flags/intrinsics_input.h"
#include "cli/flags/solve_flags.h"
#include "lowlap/core/result.h"
#include "lowlap/pipeline/internal/measure/measure_and_refine.h"
#include "lowlap/pipeline/internal/measure/measurement_choices.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap::cli {

/// Photographs that are measured, and how.
struct PhotographFlags {
  std::string images;  // folder
  std::vector<std::string> exclude;
  IntrinsicsFlags intrinsics;
  std::string pairs = "all";
  MeasurementChoices choices;
  bool refine_points = false;
  std::string cache;  // folder; empty: none
};

/// --pairs; `help` comes before what it takes.
Option AddPairsFlag(CLI::App* command, std::string* pairs,
                    const std::string& help);

/// --max-tilt.
Option AddMaxTiltFlag(CLI::App* command, double* max_tilt);

/// Their views (SceneFromImages); what must be known about the intrinsics goes
/// to the log.
Result<Scene> OpenPhotographs(const PhotographFlags& flags,
                              const RunContext& context);

/// MeasureAndRefine for what SolveAndWrite does with these flags.
Result<ImageReport> MeasurePhotographs(const PhotographFlags& flags,
                                       const SolveFlags& solve,
                                       const RunContext& context,
                                       StageLog* stages, Scene* scene);

}  // namespace lowlap::cli
