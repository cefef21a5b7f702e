#pragma once

#include <cstdint>
#include <optional>

#include "lowlap/scene/relative_pose.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"

namespace lowlap {

/// What the matches of a relative pose say about its direction.
enum class DirectionVerdict {
  kUntold,    // too few matches to say, or a rotation alone explains them
  kBorneOut,  // they fit it, and no other direction better
  kReplaced,  // they bear out another direction
  kRefuted,   // they would bear a direction out, but neither this one nor any
};

struct DirectionCheck {
  DirectionVerdict verdict = DirectionVerdict::kUntold;
  /// kReplaced: the pose with the direction that the matches bear out, refined
  /// on them (ImproveRelativePose), with the line matches that are plausible
  /// under it. Its log10_nfa is that of the given pose.
  std::optional<RelativePose> replacement;
  /// kReplaced: between the two directions.
  double error_rad = 0;
};

/// Holds a relative pose against its matches, which are those of `input`, with
/// the crossings of its lines as points. Under the rotation R of the pose a
/// match (x1, x2) lies in the epipolar plane of the normal R x1 x x2, so that
/// two of them give a direction: the other direction is that of least NFA among
/// such samples (TwoPointKernel). The two compete by
///   NFA = T C(n, k) C(k, s) alpha^(k - s),
/// k of n matches in front of both cameras and within the threshold, s = 0 for
/// the given direction, which is no fit to a sample, and 2 for the other; alpha
/// is the share of wrong matches that pass in these very images
/// (ScoreAgainstChance). An NFA below 1 bears a direction out.
///
/// Directions closer than `same_rad` are one. Of thousands of matches a
/// shuffled part decides. Degenerate: without parallax (TestTranslation) any
/// direction explains the matches, and none is borne out.
DirectionCheck CheckDirection(const TwoViewInput& input,
                              const RelativePose& pose, double same_rad,
                              std::uint64_t seed);

}  // namespace lowlap
