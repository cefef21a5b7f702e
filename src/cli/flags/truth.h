#pragma once

#include <optional>
#include <string>

#include "cli/flags/command_line.h"
#include "lowlap/core/result.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/scene/scene.h"

namespace lowlap::cli {

/// --gt
Option AddTruthFlag(CLI::App* command, std::string* path);

/// ReadGroundTruth; empty if `path` is.
Result<std::optional<GroundTruth>> LoadGroundTruth(const std::string& path,
                                                   const Scene& scene);

}  // namespace lowlap::cli
