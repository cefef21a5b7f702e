#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/flags/command_line.h"
#include "lowlap/core/result.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap::cli {

/// A scene to work on: a scene file, a problem folder of 1DSfM, a database of
/// COLMAP, or an OpenMVG listing with its matches folder. OpenMVG's flag names
/// are understood.
struct SceneInputFlags {
  std::string scene;
  std::string matches_dir;
  std::string match_file;
  std::string images;
  std::vector<std::string> exclude;
};

void AddSceneInputFlags(CLI::App* command, SceneInputFlags* flags);

struct LoadedScene {
  Scene scene;
  std::vector<PairReport> pairs;  // if the relative poses were estimated
};

/// What is asked of a scene as soon as its views are known, before long work.
using ViewCheck = std::function<Status(const Scene&)>;

/// Reads the scene without the excluded views. From the matches of OpenMVG or
/// COLMAP the relative poses are estimated, if `check`, which may be null,
/// finds nothing. kInvalidArgument if no scene is named.
Result<LoadedScene> LoadScene(const SceneInputFlags& flags,
                              const RunContext& context, StageLog* stages,
                              const ViewCheck& check = nullptr);

/// The same; kInvalidScene if there are no relative poses in the end.
Result<LoadedScene> LoadMeasuredScene(const SceneInputFlags& flags,
                                      const RunContext& context,
                                      StageLog* stages,
                                      const ViewCheck& check = nullptr);

}  // namespace lowlap::cli
