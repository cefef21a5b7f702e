#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/features.h"

namespace lowlap {

struct RetrievalOptions {
  /// Points per view that are compared; the cost grows with the square.
  int sample_points = 500;
  /// Partners that every view proposes; the pairs are those that either of
  /// their views proposes.
  int max_partners = 12;
  /// Ratio test of the sample's matches.
  double max_ratio = 0.8;

  Status Validate() const;
};

/// The pairs of views worth matching in an unordered set, without a
/// vocabulary: the points of largest scale of every view, which are few and
/// visible from afar, are matched exactly with those of every other view
/// (MatchPoints); a match is a vote. Every view proposes the partners that
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
