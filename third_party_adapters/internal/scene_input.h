#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/internal/measure/relate_and_refine.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A scene to work on: a scene file, a problem folder of 1DSfM, a database of
/// COLMAP, or an OpenMVG listing with its matches folder.
struct SceneInput {
  std::string scene;
  std::string matches_dir;
  std::string match_file;
  /// The photographs of a database or a listing: lines are detected in them.
  std::string images;
  std::vector<std::string> exclude;  // views, as FindViews knows them
};

struct LoadedScene {
  Scene scene;
  std::vector<PairReport> pairs;  // if the relative poses were estimated
};

/// What is asked of a scene as soon as its views are known, before long work.
using ViewCheck = std::function<Status(const Scene&)>;

/// Reads the scene without the excluded views. From the matches of OpenMVG or
/// COLMAP the relative poses are estimated, if `check`, which may be null,
/// finds nothing, with the intrinsics that a first solution refines
/// (RelateAndRefine). kInvalidArgument if no scene is named.
Result<LoadedScene> LoadScene(const SceneInput& input,
                              const RunContext& context, StageLog* stages,
                              const ViewCheck& check = nullptr,
                              const FirstSolution& first = {});

/// The same, with the intrinsics with which the relative poses were measured
/// (RestoreGivenIntrinsics); kInvalidScene if there are none in the end.
Result<LoadedScene> LoadMeasuredScene(const SceneInput& input,
                                      const RunContext& context,
                                      StageLog* stages,
                                      const ViewCheck& check = nullptr,
                                      const FirstSolution& first = {});

}  // namespace lowlap
