#pragma once

#include <optional>
#include <vector>

#include "lowlap/core/random.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/robust/a_contrario.h"
#include "lowlap/two_view/essential_kernel.h"
#include "lowlap/two_view/relative_pose_estimator.h"

namespace lowlap {

struct PoseCandidate {
  RigidTransform pose;
  AContrarioScore score;     // against chance
  std::vector<int> inliers;  // visible, within the threshold; ascending
};

/// The search for the motion of one pair: a-contrario RANSAC, sharpening,
/// and refinement with the threshold re-estimated.
class PoseSearch {
 public:
  static constexpr double kMinThresholdPx = 0.1;

  /// `pairs` are in random order and outlive the search.
  PoseSearch(const PointPairs& pairs, const BackgroundLaw& law,
             const TwoViewOptions& options);

  /// The best motion; nullopt if no sample gave one.
  std::optional<PoseCandidate> Search(Random& random, int& num_samples);

  /// A motion brought to its optimum: the signs that see most inliers, then
  /// threshold, inliers and refinement in turn until they agree.
  PoseCandidate Finish(const RigidTransform& cam2_from_cam1) const;

  /// Truncated Cauchy score of the visible matches,
  ///   sum log(1 + 9) - log(1 + min(r^2 / s^2, 9)),
  /// to compare motions at one scale s.
  double CoreScore(const RigidTransform& cam2_from_cam1, double scale_px) const;

  /// Scale of the Cauchy loss in the final refinement.
  static double LossScalePx(const PoseCandidate& candidate) {
    return 0.5 * candidate.score.threshold;
  }

 private:
  AContrarioLadder Ladder(double max_threshold_px) const;
  RigidTransform WithMostVisible(const RigidTransform& cam2_from_cam1) const;

  EssentialKernel kernel_;
  BackgroundLaw law_;
  TwoViewOptions options_;
  /// Bound of the threshold once the precision of the points is known.
  double max_threshold_px_;
};

}  // namespace lowlap
