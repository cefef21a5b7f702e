#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/lines/line_matching.h"
#include "lowlap/matching/internal/points/point_matching.h"
#include "lowlap/matching/match_options.h"

namespace lowlap {

/// Putative matches of a pair of views, before any geometry.
struct PairMatches {
  std::vector<FeatureMatch> points;
  std::vector<FeatureMatch> lines;
};

/// Matches of two views; points of a starved pair once more with a wider ratio
/// test (MatchPointsRelaxed).
PairMatches MatchPair(const DetectedFeatures& first,
                      const DetectedFeatures& second,
                      const MatchOptions& options);

/// Matches every pair, one pair per thread. A pair that names a view without
/// features is kInvalidArgument.
Result<std::map<ViewPair, PairMatches>> MatchFeatures(
    const std::map<ViewId, DetectedFeatures>& features,
    const std::vector<ViewPair>& pairs, const MatchOptions& options,
    const RunContext& context);

}  // namespace lowlap
