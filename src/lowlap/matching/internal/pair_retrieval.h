#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/match_options.h"

namespace lowlap {

/// The pairs of views worth matching in an unordered set, without a
/// vocabulary: the points of largest scale of every view, which are few and
/// visible from afar, are matched exactly with those of every other view
/// (MatchPoints); a match is a vote. Of more than `max_exhaustive` views, each
/// point instead votes for the views of its neighbours among all points
/// (ApproximateIndex), as far as these are nearer than `max_ratio` times the
/// last of 32, which stands for chance. Every view proposes the partners that
/// share the most votes with it, and the pairs of a maximum spanning forest are
/// added: whatever votes connect stays connected. A pair without a vote is
/// never proposed, unless no view can have more than `max_partners` partners:
/// such a small set is matched completely, and nothing is compared.
///
/// Sorted, each with first < second; the same for any number of threads.
Result<std::vector<ViewPair>> RetrievePairs(
    const std::map<ViewId, DetectedFeatures>& features,
    const RetrievalOptions& options, const RunContext& context);

}  // namespace lowlap
