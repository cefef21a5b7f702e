#pragma once

#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// How far from a solution a measurement contradicts it.
struct ReliabilityOptions {
  /// In robust standard deviations of all residuals of its kind.
  double reach = 5.0;
  /// Deviation of a direction, in radians; no stated deviation counts as less.
  double direction_stddev_rad = kPoseErrorFloorRad;
};

/// Which views of component 0 are doubtful by what is measured, without any
/// structure: the first three reasons. The evidence of a relative pose is
/// 1 - min(0, log10 NFA). A relative pose contradicts if it was left out, or if
/// its direction is further than `reach` deviations from the centres. A ratio
/// contradicts if it is further than that, and by a tenth at least; those that
/// agree carry the scale (Diagnose, on the relative poses and ratios that
/// agree), and ratios across one camera are contradicted if those rejected
/// there, between the same parts, have more than half their evidence.
std::vector<ReliabilityWarning> FindReliabilityWarnings(
    const Scene& scene, const TranslationProblem& problem,
    const TranslationSolution& solution, const ReliabilityOptions& options);

/// The fourth: views with a pose and an intrinsic of whose features fewer than
/// half are observations of a landmark. Features are those on point tracks over
/// two such views or more, and on line tracks over three or more (two views of
/// a line fit any poses, however many pieces of it they have); the pieces of a
/// line in one view count once. Views without any have no entry.
std::vector<ReliabilityWarning> FindLostFeatures(const Scene& scene);

}  // namespace lowlap
