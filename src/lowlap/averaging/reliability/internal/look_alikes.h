#pragma once

#include <vector>

#include "lowlap/averaging/reliability/internal/expected_overlap.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What the structure says of relative poses that join places that look alike.
///
/// The two sides of a house, or the windows of a corridor, that are alike in
/// part give relative poses that agree with one another and with their matches.
/// But they put views before the same place that see different things there:
/// what one of them sees should be found in the other one all over what they
/// have in common, and is in the part that is alike only.
///
/// Groups of views grow along the relative poses that agree, those of most
/// evidence first, unless the groups that one joins are different: of the
/// regions of all that they should both see (of pairs that should share a
/// fifth, OverlapPredictor::RegionsOf), a fifth are bare, as many as by chance
/// in one of a hundred scenes at most (Log10ChanceOfBare, times the pairs), a
/// chance of 2 kChanceOfBare each. Where there are look-alikes there are others
/// like them: if any are found, a tenth is enough, and that chance itself. So
/// they are where relative poses that contradict the solution join the groups,
/// with more than a quarter of the evidence of those in use: one or the other
/// joins look-alikes, and what one of ten scenes has by chance is enough there.
struct LookAlikes {
  /// Pairs of views of groups that are different, if they should share a fifth
  /// of what they see.
  std::vector<ViewPair> different;
  /// Relative poses that agree, between groups that are different.
  std::vector<ViewPair> false_poses;
  /// If there are any, the views of all groups but the largest, or of all if
  /// that has no majority.
  std::vector<ViewId> doubtful;
};

/// Of the pairs with a relative pose, and those compared in vain, as `overlaps`
/// has them. `summary.look_alikes`: those of an earlier solution, if any. The
/// min_rate of the regions is three quarters of the found share that a quarter
/// of the relative poses exceed, of those that agree and should share a fifth:
/// on photographs the least is at 0.7 of that. Cost: pairs times 1,024 points,
/// and the views times the relative poses; the same for any number of threads.
/// Error: kCancelled.
Result<LookAlikes> FindLookAlikes(const Scene& scene,
                                  const PoseSummary& summary,
                                  const ExpectedOverlaps& overlaps,
                                  const RunContext& context);

}  // namespace lowlap
