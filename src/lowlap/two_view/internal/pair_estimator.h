#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/lines/guided_line_matching.h"
#include "lowlap/matching/internal/lines/line_transfer.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "lowlap/two_view/two_view_options.h"

namespace lowlap {

/// What is known of one view, worked out once for all its pairs.
struct ViewMeasurements {
  NormalizedFeatures features;
  std::vector<VanishingDirection> directions;
  std::vector<Mat2> point_covariances;         // empty: unknown
  RepeatedPattern repeats;                     // without `detected`: empty
  const DetectedFeatures* detected = nullptr;  // not owned; null: see below
  Vec2 image_size_px = Vec2::Zero();
};

/// With `detected`, what the detectors know of the same features (same order),
/// the shapes of the points' errors count, what repeats is told from what does
/// not, and pairs can be matched again under their first pose. Null: matches
/// are all there is.
ViewMeasurements MeasureView(const ViewFeatures& features,
                             const Intrinsic& intrinsic,
                             const Vec2& image_size_px,
                             const DetectedFeatures* detected,
                             const VanishingOptions& options);

/// What is known of a pair before its geometry, without matches. It refers to
/// the measurements.
TwoViewInput InputOf(const ViewPair& views, const ViewMeasurements& first,
                     const ViewMeasurements& second);

struct PairEstimate {
  std::optional<RelativePose> pose;
  std::string reason;  // why there is none
  /// Point inliers that hold the pose alone (TwoViewResult).
  std::vector<FeatureMatch> lone_matches;
  /// No pose, since a rotation alone explains what the views see.
  bool no_parallax = false;
  /// Of the pose of least NFA, if any was meaningful.
  std::optional<TwoViewGeometry> geometry;
  double log10_nfa = 0;
  /// Of `pose`, with what repeats.
  double log10_nfa_with_repeats = 0;
  int num_point_inliers = 0;
};

/// Matches of a pair to those of them that may be used; empty: all.
using MatchFilter =
    std::function<std::vector<FeatureMatch>(const std::vector<FeatureMatch>&)>;

/// Of what is matched under a pose.
struct GuidedMatchFilters {
  MatchFilter points;
  MatchFilter lines;
};

/// The relative pose of a pair from its putative matches (MatchPair), in four
/// steps: estimate (EstimateRelativePose); guide, that is, match lines and, for
/// starved pairs, points again under this pose; improve the pose on all of
/// these (ImproveRelativePose), and its alternatives; keep the line matches
/// that are plausible under it. Where two poses explain what the pair sees, the
/// other is kept as an alternative. A pair whose direction is undetermined has
/// none, nor has one that only patterns bear out that repeat.
PairEstimate EstimatePair(const ViewPair& views, const ViewMeasurements& first,
                          const ViewMeasurements& second,
                          const PairMatches& putative,
                          const PairOptions& options, std::uint64_t seed,
                          const GuidedMatchFilters& filters = {});

/// A relative pose (at any baseline) that is known already, taken as it is:
/// with all point matches, and the line matches that are plausible under it.
PairEstimate TakePair(const ViewPair& views, const ViewMeasurements& first,
                      const ViewMeasurements& second,
                      const PairMatches& matches,
                      const RigidTransform& cam2_from_cam1,
                      const PairOptions& options);

/// The pose improved once more on its inliers, after features have moved; as it
/// was, where that leads nowhere. Whether it is of one plane, and which rivals
/// it had, inliers do not tell: what its covariance said of that it still says
/// (KeptCovariance). `lone_matches` are as in TwoViewResult.
RelativePose RefinePair(const RelativePose& pose, const ViewMeasurements& first,
                        const ViewMeasurements& second,
                        const PairOptions& options,
                        std::vector<FeatureMatch>* lone_matches = nullptr);

}  // namespace lowlap
