#pragma once

#include <vector>

#include "lowlap/core/ids.h"

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
  /// Relative poses that neither their own matches nor the others bear out,
  /// that their matches hardly determine, or that have a weakness, are all that
  /// holds the views.
  kUntoldPoses,
  /// What agrees with the solution does not hold the views: relative poses and
  /// ratios that contradict it were kept, since else they would be lost.
  kUnheld,
  /// Doubtful views are all that holds the views.
  kDoubtfulNeighbors,
  /// Most of what was matched in a view does not fit its pose.
  kLostFeatures,
  /// At their places, views should see what others see that they were compared
  /// with in vain.
  kMissingMatches,
  /// Places that look alike may have been taken for one: beside what the views
  /// have in common, they see other things than views at the same place.
  kLookAlikes,
  /// By their stated deviations, the views may be further off than is promised
  /// of firm ones.
  kImprecise,
};

/// "contradicted_poses", "weak_scale", "contradicted_ratios", "untold_poses",
/// "unheld", "doubtful_neighbors", "lost_features", "missing_matches",
/// "look_alikes", "imprecise".
const char* WarningReasonName(WarningReason reason);

/// Placed views whose place is doubtful, and why.
struct ReliabilityWarning {
  WarningReason reason = WarningReason::kContradictedPoses;
  std::vector<ViewId> views;  // sorted
  /// kContradictedPoses and kUnheld: the relative poses that contradict.
  std::vector<ViewPair> against;
  /// kUntoldPoses: the relative poses of these views, in use, that nothing
  /// bears out.
  std::vector<ViewPair> untold;
  /// kMissingMatches, kLookAlikes: the pairs that should see the same things.
  std::vector<ViewPair> missing;
  /// kWeakScale: the ratios in use. kContradictedRatios: those rejected.
  std::vector<ViewTriplet> ratios;
  /// kLostFeatures: the share of the features that fit. kImprecise: the
  /// standard deviation of the centre, in shares of the scene's size.
  double share = 0;
};

}  // namespace lowlap
