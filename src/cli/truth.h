#pragma once

#include <optional>
#include <string>

#include "cli/command_line.h"
#include "lowlap/core/result.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/scene/scene.h"

namespace lowlap::cli {

/// --gt
Option AddTruthFlag(CLI::App* command, std::string* path);

/// The true poses of a Strecha folder, matched by image name, of a scene file,
/// by name or by id (GroundTruthFromScene), or of a problem folder of 1DSfM, by
/// view id; empty if `path` is. kInsufficientData if no view of the scene is
/// among them.
Result<std::optional<GroundTruth>> LoadGroundTruth(const std::string& path,
                                                   const Scene& scene);

}  // namespace lowlap::cli
