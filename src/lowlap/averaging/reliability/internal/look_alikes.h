#pragma once

#include <vector>

#include "lowlap/averaging/reliability/internal/expected_overlap.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What the structure says of relative poses that join places that look alike.
///
/// The two sides of a house, or the windows of a corridor, that are alike in
/// part give relative poses that agree with one another and with their matches.
/// But they put views before the same place that see different things there:
/// what one of them sees should be found in the other one all over what they
/// have in common, and is in the part that is alike only.
struct LookAlikes {
  /// Pairs of views that cannot both be right: they should share a fifth of
  /// what they see (OverlapPredictor), and of the regions of that a fifth are
  /// bare, as many as by chance in one of a hundred scenes at most
  /// (Log10ChanceOfBare, times the pairs).
  std::vector<ViewPair> different;
  /// Relative poses that agree, between groups of views. The groups grow by
  /// evidence: those that the most evidence joins become one, unless all that
  /// they have in common, together, is as bare as that.
  std::vector<ViewPair> false_poses;
  /// If there are any, the views of all groups but the largest, or of all if
  /// that has no majority.
  std::vector<ViewId> doubtful;
};

/// Of the pairs with a relative pose, and those compared in vain, as `overlaps`
/// has them. Cost: the pairs; where views are different, the views times the
/// pairs.
LookAlikes FindLookAlikes(const Scene& scene, const PoseSummary& summary,
                          const ExpectedOverlaps& overlaps);

}  // namespace lowlap
