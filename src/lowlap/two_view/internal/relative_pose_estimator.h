#pragma once

#include <cstdint>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/directions/internal/vanishing_directions.h"
#include "lowlap/geometry/types.h"
#include "lowlap/matching/internal/repeats/repeated_pattern.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/relative_pose.h"
#include "lowlap/two_view/internal/search/rival_spread.h"
#include "lowlap/two_view/two_view_options.h"

namespace lowlap {

/// What is known of a pair of views before its geometry. The features are not
/// owned and must outlive the call; they must not be null.
struct TwoViewInput {
  ViewPair views;
  const NormalizedFeatures* features1 = nullptr;
  const NormalizedFeatures* features2 = nullptr;
  std::vector<FeatureMatch> point_matches;  // putative, with wrong ones
  std::vector<FeatureMatch> line_matches;   // likewise; segment indices
  /// Shapes of the errors of all points (LocalizationCovariance); null: round.
  const std::vector<Mat2>* point_covariances1 = nullptr;
  const std::vector<Mat2>* point_covariances2 = nullptr;
  /// Of the views' segments (FindVanishingDirections); null: lines say nothing.
  const std::vector<VanishingDirection>* directions1 = nullptr;
  const std::vector<VanishingDirection>* directions2 = nullptr;
  /// What repeats in the views; null: nothing is known of it.
  const RepeatedPattern* repeats1 = nullptr;
  const RepeatedPattern* repeats2 = nullptr;
  Vec2 image_size1_px = Vec2::Zero();  // width, height
  Vec2 image_size2_px = Vec2::Zero();
};

/// What kind of scene the matches show.
enum class TwoViewGeometry {
  kGeneral,
  /// Most inliers lie on one plane, which two motions explain; what lies off
  /// the plane, visibility, or directions decided for `pose` (MotionLead).
  kPlanar,
  /// The same, but nothing decides: `pose` is the likelier one of them,
  /// `alternatives` holds the other.
  kAmbiguousPlane,
  /// Rotation without translation that the noise would let us see: the
  /// rotation of `pose` is good, its direction means nothing.
  kRotationOnly,
};

const char* TwoViewGeometryName(TwoViewGeometry geometry);

struct TwoViewResult {
  RelativePose pose;
  /// Those of its point inliers that hold it alone (BorneOutMatches): of these
  /// its covariance knows nothing.
  std::vector<FeatureMatch> lone_matches;
  TwoViewGeometry geometry = TwoViewGeometry::kGeneral;
  /// Other optima of the search. Of their spread the covariance of `pose` knows
  /// nothing; EstimatePair adds it.
  std::vector<RivalPose> rivals;
  /// Other motions that the points cannot exclude (log10 NFA < 0, too); line or
  /// triplet evidence may. Empty unless kAmbiguousPlane.
  std::vector<RelativePose> alternatives;

  /// All that speaks for `pose` lies on one plane (ParallaxEvidence): it is
  /// refined on the plane, and its covariance is what the plane leaves open.
  bool is_of_one_plane = false;

  /// log10 NFA of `pose` for matches that lie apart (ScatteredEvidence): what
  /// it means if those side by side are not independent.
  double scattered_log10_nfa = 0;

  /// log10 NFA with what repeats of the motion that has most of it: `pose`, or
  /// one that gave way to it.
  double log10_nfa_with_repeats = 0;
  /// `pose` is of what does not repeat, to which the copies' motion gave way.
  bool is_of_unrepeated = false;

  // Diagnostics.
  int num_matches = 0;  // usable points and crossings
  int num_samples = 0;
  /// Inliers that a rotation alone explains.
  int num_rotation_inliers = 0;
  /// Inliers that lie on the dominant plane.
  int num_plane_inliers = 0;

  bool HasDirection() const {
    return geometry != TwoViewGeometry::kRotationOnly;
  }
};

/// Rotation and direction of the translation of a calibrated pair, by
/// a-contrario RANSAC (Moisan, Stival 2004). Hypotheses come from five points;
/// and from the rotation of two pairs of parallel lines (their vanishing
/// directions, no orthogonality assumed: Salaün, Marlet, Monasse, ECCV 2016)
/// with the translation from two points. Crossings of neighbouring matched
/// lines take part as points. Every motion is refined on points, crossings and
/// common directions together; the one with the greatest score (core of small
/// residuals, less what the directions have against it) wins.
///
/// Residual: the Sampson distance of x2^T [t]x R x1 = 0 in pixels. The
/// threshold that separates inliers is the one of least NFA; there is none to
/// set. Of the poses that explain the inliers, the one with the sharpest core
/// of small residuals is taken (see SharpenPose), and refined with a Cauchy
/// loss whose scale is that of all residuals within max_threshold_px (see
/// PoseSearch::Finish). The sign of t and the choice of R come from the
/// visibility (positive depths) of all inliers; matches behind a
/// camera are no inliers. log10_nfa counts chance support as these very images
/// give it (see ScoreAgainstChance), and of a pose only what does not repeat
/// within its photograph (see FindEvidenceBeyondRepeats). Where that speaks
/// more for another motion, of whose inliers the first explains less than half,
/// it is the result: one window for the next of a facade agree on a motion,
/// too, and may be more. So is one of which the first explains more, but which
/// it misses by half a degree (SamePose), and by a factor of 1000 in NFA,
/// unless that leaves two motions open. Two different places that look alike
/// without that still pass: what surrounds them (Log10ChanceOfSurroundings) and
/// further views may tell.
///
/// `pose` carries rotation, direction, point inliers in the order of
/// `point_matches`, log10_nfa, point_threshold_px and covariance; its line
/// inliers are left to the caller. The same input and seed give the same
/// result.
///
/// Errors: kInsufficientData when fewer than 6 points and crossings are usable
/// or no pose has log10 NFA < 0, with what repeats or without (the message says
/// which); kInvalidArgument for matches that refer to features that do not
/// exist, or empty images.
Result<TwoViewResult> EstimateRelativePose(const TwoViewInput& input,
                                           const TwoViewOptions& options,
                                           std::uint64_t seed);

/// The pose refined on matches that were found with its help: threshold,
/// inliers and covariance are those of the new matches, evidence and weakness
/// stay those of the first ones, which knew nothing of the pose.
/// Where too few of them fit the pose to refine it, it comes back as it was.
/// `input` is valid; its line matches count with their crossings and
/// directions. `is_of_one_plane` and, if not null, `lone_matches` are as in
/// TwoViewResult: matches found with the pose lie on its epipolar lines, and
/// cannot tell.
RelativePose ImproveRelativePose(
    const TwoViewInput& input, const RelativePose& pose, bool is_of_one_plane,
    const TwoViewOptions& options,
    std::vector<FeatureMatch>* lone_matches = nullptr);

}  // namespace lowlap
