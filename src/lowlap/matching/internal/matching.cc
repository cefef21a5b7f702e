#include "lowlap/matching/internal/matching.h"

#include <string>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {

Status MatchOptions::Validate() const {
  LOWLAP_RETURN_IF_ERROR(points.Validate());
  LOWLAP_RETURN_IF_ERROR(relaxed_points.Validate());
  LOWLAP_RETURN_IF_ERROR(tilted_points.Validate());
  return lines.Validate();
}

PairMatches MatchPair(const DetectedFeatures& first,
                      const DetectedFeatures& second,
                      const MatchOptions& options) {
  PairMatches matches;
  if (options.match_points) {
    matches.points = MatchPoints(first.point_descriptors,
                                 second.point_descriptors, options.points);
    if (matches.points.size() <
        static_cast<std::size_t>(options.relaxed_points.starved_below)) {
      matches.points = MatchPointsRelaxed(first, second, matches.points,
                                          options.relaxed_points);
    }
  }
  if (options.match_lines) {
    matches.lines = MatchLines(
        {first.features.segments, first.line_descriptors},
        {second.features.segments, second.line_descriptors}, options.lines);
  }
  return matches;
}

Result<std::map<ViewPair, PairMatches>> MatchFeatures(
    const std::map<ViewId, DetectedFeatures>& features,
    const std::vector<ViewPair>& pairs, const MatchOptions& options,
    const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  for (const ViewPair& pair : pairs) {
    for (const ViewId id : {pair.first, pair.second}) {
      if (features.count(id) == 0) {
        return MakeError(
            ErrorCode::kInvalidArgument,
            "no features were detected in view " + std::to_string(id.value()));
      }
    }
  }
  std::vector<PairMatches> results(pairs.size());
  const Status done =
      ParallelFor(context, "matching", pairs.size(), [&](std::size_t i) {
        results[i] = MatchPair(features.at(pairs[i].first),
                               features.at(pairs[i].second), options);
      });
  if (!done) return tl::unexpected<Error>(done.error());
  std::map<ViewPair, PairMatches> matches;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    matches.emplace(pairs[i], std::move(results[i]));
  }
  return matches;
}

}  // namespace lowlap
