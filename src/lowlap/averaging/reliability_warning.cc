#include "lowlap/averaging/reliability_warning.h"

namespace lowlap {

const char* WarningReasonName(WarningReason reason) {
  switch (reason) {
    case WarningReason::kContradictedPoses:
      return "contradicted_poses";
    case WarningReason::kWeakScale:
      return "weak_scale";
    case WarningReason::kContradictedRatios:
      return "contradicted_ratios";
    case WarningReason::kUntoldPoses:
      return "untold_poses";
    case WarningReason::kUnheld:
      return "unheld";
    case WarningReason::kDoubtfulNeighbors:
      return "doubtful_neighbors";
    case WarningReason::kLostFeatures:
      return "lost_features";
    case WarningReason::kMissingMatches:
      return "missing_matches";
    case WarningReason::kLookAlikes:
      return "look_alikes";
    case WarningReason::kImprecise:
      return "imprecise";
  }
  return "";
}

}  // namespace lowlap
