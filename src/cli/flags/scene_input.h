#pragma once

#include <vector>

#include "cli/flags/command_line.h"
#include "cli/flags/distinct_files.h"
#include "cli/flags/solve_flags.h"
#include "third_party_adapters/internal/scene_input.h"

namespace lowlap::cli {

using SceneInputFlags = SceneInput;

/// The scene, -m, -M, --images and --exclude; OpenMVG's flag names are
/// understood.
void AddSceneInputFlags(CLI::App* command, SceneInputFlags* flags);

/// LoadMeasuredScene for commands that go on to solve. The adjustment of a
/// scene file starts from the calibration as it was given; what is related here
/// starts from what it was related with.
Result<LoadedScene> LoadSceneToSolve(const SceneInputFlags& flags,
                                     const SolveFlags& solve,
                                     const RunContext& context,
                                     StageLog* stages, const ViewCheck& check);

/// The files that they name. OpenMVG keeps the listing in the matches folder,
/// whichever is named.
std::vector<NamedFile> InputFiles(const SceneInputFlags& flags);

}  // namespace lowlap::cli
