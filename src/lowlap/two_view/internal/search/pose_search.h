#pragma once

#include <optional>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/robust/internal/a_contrario.h"
#include "lowlap/two_view/internal/kernels/essential_kernel.h"
#include "lowlap/two_view/internal/parallel_directions.h"
#include "lowlap/two_view/internal/planes/planar_motion.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {

struct PoseCandidate {
  RigidTransform pose;
  AContrarioScore support;   // of the points, against chance
  std::vector<int> inliers;  // visible, within the threshold; ascending
  double direction_penalty = 0;
  double loss_scale_px = 0;  // of the last refinement
  /// The plane to which alone it is due (PoseSearch::TieToPlane), if any.
  std::optional<ScenePlane> plane;

  /// What speaks for it, in decimal digits: the core score of the points less
  /// the penalty of the directions.
  double score = 0;

  /// Whether chance does not explain its points.
  bool IsMeaningful() const { return support.log10_nfa < 0; }
};

/// Whether a is the better candidate: a meaningful one before one that is not,
/// whatever speaks for that (false directions may have almost nothing against a
/// rotation, and no point for it), then the greater score.
bool IsBetter(const PoseCandidate& a, const PoseCandidate& b);

/// The search for the motion of one pair, from points and common directions.
class PoseSearch {
 public:
  static constexpr double kMinThresholdPx = 0.1;

  /// `pairs` are in random order and outlive the search.
  PoseSearch(const PointPairs& pairs, std::vector<DirectionPair> directions,
             const BackgroundLaw& law, const TwoViewOptions& options);

  /// Motions worth a look, no two of them the same (SamePose), the best first
  /// (IsBetter): those of five-point samples (a-contrario RANSAC, sharpened),
  /// and for each rotation that two pairs of directions give, that of two-point
  /// samples. Empty if no sample gave one.
  std::vector<PoseCandidate> Search(Random& random, int& num_samples);

  /// The motion of two-point samples under a rotation; nullopt: no sample gave
  /// one.
  std::optional<RigidTransform> MotionWithRotation(const Mat3& rotation,
                                                   Random& random,
                                                   int& num_samples) const;

  /// What speaks for a motion as it is (PoseCandidate::score).
  double ScoreOf(const RigidTransform& cam2_from_cam1) const;

  /// What the points say for a motion as it is, against chance.
  AContrarioScore SupportOf(const RigidTransform& cam2_from_cam1) const;

  /// A motion brought to its optimum: the signs that see most inliers, then the
  /// scale of the residuals (TruncatedCauchyScale, within the greatest
  /// threshold) and refinement in turn until they agree. The first loss is
  /// twice as wide: of optima side by side that leads to the same one as a
  /// rule, wherever the search began. The threshold of least NFA has no part in
  /// it: it is a step of a ladder, and over several steps the NFA often is as
  /// good as equal.
  PoseCandidate Finish(const RigidTransform& cam2_from_cam1) const;

  /// Takes the places of the inliers on a plane into account, in which all that
  /// speaks for the motion lies. The motion stays as it was if chance explains
  /// the other one.
  void TieToPlane(const ScenePlane& plane, PoseCandidate* candidate) const;

  /// Truncated Cauchy scores of the matches,
  ///   log(1 + 9) - log(1 + min(r^2 / s^2, 9)),
  /// 0 of those that are not visible, to compare motions at one scale s.
  std::vector<double> CoreScores(const RigidTransform& cam2_from_cam1,
                                 double scale_px) const;

  /// The loss of the final refinement.
  PoseRefinementOptions RefinementOptions(const PoseCandidate& candidate) const;

 private:
  std::vector<RigidTransform> FivePointMotions(Random& random,
                                               int& num_samples);
  RigidTransform WithMostVisible(const RigidTransform& cam2_from_cam1) const;
  // Of the matches that are visible within the greatest threshold.
  double NoiseScalePx(const RigidTransform& cam2_from_cam1,
                      const std::vector<int>& visible) const;

  EssentialKernel kernel_;
  std::vector<DirectionPair> directions_;
  BackgroundLaw law_;
  TwoViewOptions options_;
  /// Bound of the threshold, and scale of the core, once the precision of the
  /// points is known.
  double max_threshold_px_;
  double core_scale_px_;
};

}  // namespace lowlap
