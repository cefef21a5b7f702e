#pragma once

#include "cli/flags/command_line.h"
#include "third_party_adapters/internal/scene_input.h"

namespace lowlap::cli {

using SceneInputFlags = SceneInput;

/// The scene, -m, -M, --images and --exclude; OpenMVG's flag names are
/// understood.
void AddSceneInputFlags(CLI::App* command, SceneInputFlags* flags);

}  // namespace lowlap::cli
