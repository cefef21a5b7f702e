#pragma once

#include <map>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/internal/measure/relate_and_refine.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What another program measured of the scene's views: matches of the points in
/// scene.features, and the poses of pairs that it knows (as in
/// EstimateRelativePoses).
struct MatchedPoints {
  std::map<ViewPair, std::vector<FeatureMatch>> matches;
  std::map<ViewPair, RigidTransform> cam2_from_cam1;
};

enum class PhotographUse {
  kNone,
  /// Lines are detected and matched in the photographs (Scene::ImagePath).
  kLines,
  /// The same, if there are any.
  kLinesIfThere,
};

/// From the points of another program to relative poses and tracks
/// (EstimateRelativePoses), with the intrinsics that a first solution refines
/// (RelateAndRefine). Views whose photograph is missing or unusable have points
/// alone; the log names them. Errors: those of EstimateRelativePoses; that of
/// the first photograph if none is usable, with kLines.
Result<std::vector<PairReport>> RelateMatchedPoints(
    const MatchedPoints& points, PhotographUse use,
    const RelativePoseOptions& options, const FirstSolution& first,
    const RunContext& context, StageLog* stages, Scene* scene);

}  // namespace lowlap
