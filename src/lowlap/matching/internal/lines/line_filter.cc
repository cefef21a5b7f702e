#include "lowlap/matching/internal/lines/line_filter.h"

#include <cmath>
#include <optional>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/matching/internal/lines/line_transfer.h"

namespace lowlap {

Status LineFilterOptions::Validate() const {
  return Require({{min_overlap >= 0 && min_overlap <= 1,
                   "min_overlap of lines must lie in [0, 1]"},
                  {min_epipolar_angle_deg >= 0 && min_epipolar_angle_deg < 90,
                   "min_epipolar_angle_deg must lie in [0, 90)"}});
}

std::vector<FeatureMatch> FilterLineMatches(
    const std::vector<FeatureMatch>& matches, const NormalizedFeatures& first,
    const NormalizedFeatures& second, const RigidTransform& cam2_from_cam1,
    const LineFilterOptions& options) {
  const double min_sine = std::sin(RadFromDeg(options.min_epipolar_angle_deg));
  std::vector<FeatureMatch> kept;
  for (const FeatureMatch& match : matches) {
    if (match.first >= first.segments.size() ||
        match.second >= second.segments.size()) {
      continue;
    }
    const auto transfer =
        TransferLine(first.segments[match.first], second.segments[match.second],
                     cam2_from_cam1, min_sine, 0);
    if (transfer && transfer->overlap_of_shorter >= options.min_overlap) {
      kept.push_back(match);
    }
  }
  return kept;
}

}  // namespace lowlap
