#pragma once

#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

enum class WarningReason {
  /// The relative poses of a view that contradict its place have more evidence
  /// than those that agree with it.
  kContradictedPoses,
  /// Only ratios that are too weak to rely on alone (IsWeak) give the views the
  /// scale of the others.
  kWeakScale,
  /// The ratios that give the views the scale of the others, across one camera
  /// or all of them, disagree with one another.
  kContradictedRatios,
  /// Most of what was matched in a view does not fit its pose.
  kLostFeatures,
};

/// "contradicted_poses", "weak_scale", "contradicted_ratios", "lost_features".
const char* WarningReasonName(WarningReason reason);

/// Placed views whose place is doubtful, and why.
struct ReliabilityWarning {
  WarningReason reason = WarningReason::kContradictedPoses;
  std::vector<ViewId> views;  // sorted
  /// kContradictedPoses: the relative poses that contradict.
  std::vector<ViewPair> against;
  /// kWeakScale: the ratios in use. kContradictedRatios: those rejected.
  std::vector<ViewTriplet> ratios;
  /// kLostFeatures: the share of the features that fit.
  double share = 0;
};

/// How far from a solution a measurement contradicts it.
struct ReliabilityOptions {
  /// In robust standard deviations of all residuals of its kind.
  double reach = 5.0;
  /// Deviation of a direction, in radians; no stated deviation counts as less.
  double direction_stddev_rad = 1e-3;
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
