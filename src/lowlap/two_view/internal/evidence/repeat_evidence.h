#pragma once

#include <optional>
#include <vector>

#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "lowlap/two_view/internal/shuffled_matches.h"

namespace lowlap {

/// What is left of the evidence for a pose without what repeats.
struct EvidenceBeyondRepeats {
  double log10_nfa = 0;  // of the rest; infinite if it is too little
  int num_repeated = 0;  // matches and crossings that belong to a pattern
  int num_others = 0;
};

/// The matches and crossings of which neither side belongs to a pattern of its
/// view (RepeatedPattern), as indices of `matches.pairs`. nullopt: nothing is
/// known to repeat, or no match does.
std::optional<std::vector<int>> MatchesBeyondRepeats(
    const TwoViewInput& input, const ShuffledMatches& matches);

/// Where a pattern repeats, the copies of one place agree on a motion as well
/// as those of another, or of another building with the same windows: any
/// number of their matches says that the patterns are alike, and nothing of
/// where the photographs were taken. So a pose counts for what the matches and
/// crossings have for it of which neither side belongs to a pattern of its view
/// (RepeatedPattern), against chance. `matches` are those of the input.
/// nullopt: nothing is known to repeat, or no match does.
std::optional<EvidenceBeyondRepeats> FindEvidenceBeyondRepeats(
    const TwoViewInput& input, const ShuffledMatches& matches,
    const RelativePose& pose, const TwoViewOptions& options);

}  // namespace lowlap
