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
  /// As in PoseOptions: nor does a direction contradict that is closer than
  /// three times this.
  double least_false_rad = 0;
};

/// Which views of component 0 are doubtful by what is measured, without any
/// structure: all reasons but the last two. `firm` becomes what the firm views
/// stand on.
///
/// - The evidence of a relative pose is 1 - min(0, log10 NFA). It contradicts a
///   view if it was left out, though not for its own matches, or is further
///   than `reach` deviations from the centres.
/// - Views hold each other where the relative poses and ratios that are in use
///   and agree with the solution fix their places (AnalyzeRigidity). The firm
///   ones are the largest set that is held without weak ratios (IsWeak), and
///   without relative poses of which their matches tell nothing (`matches`) or
///   whose stated deviation is more than that of a weak ratio, and whose views
///   would not hold each other without them and weak ratios; two views are none
///   if the scene has more.
///   Every other view hangs on what was set aside, or on other such views, and
///   is doubtful for it; if they are half of the placed views or more, so are
///   the firm ones: nothing says which of the parts is in its place. A ratio
///   agrees within `reach` deviations, or a tenth.
/// - Ratios across one camera are contradicted if those rejected there, between
///   the same parts, have more than half their evidence.
std::vector<ReliabilityWarning> FindReliabilityWarnings(
    const Scene& scene, const TranslationProblem& problem,
    const TranslationSolution& solution, const MatchVerdicts& matches,
    const ReliabilityOptions& options, FirmEvidence* firm);

}  // namespace lowlap
