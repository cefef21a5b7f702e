#include "lowlap/two_view/internal/repeat_evidence.h"

#include <algorithm>
#include <limits>

#include "lowlap/two_view/internal/search/pose_search.h"

namespace lowlap {
namespace {

/// Crossings of lines have no window of their own.
constexpr double kCrossingScale_px = std::numeric_limits<double>::infinity();

bool IsRepeated(const TwoViewInput& input, const ShuffledMatches& matches,
                int n) {
  const int m = matches.match_of_pair[n];
  if (m == ShuffledMatches::kCrossing) {
    return input.repeats1->Covers(matches.pairs.x1[n], kCrossingScale_px) ||
           input.repeats2->Covers(matches.pairs.x2[n], kCrossingScale_px);
  }
  const FeatureMatch& match = input.point_matches[m];
  return input.repeats1->HasPoint(match.first) ||
         input.repeats2->HasPoint(match.second);
}

}  // namespace

std::optional<EvidenceBeyondRepeats> FindEvidenceBeyondRepeats(
    const TwoViewInput& input, const ShuffledMatches& matches,
    const RelativePose& pose, const TwoViewOptions& options) {
  if (input.repeats1 == nullptr || input.repeats2 == nullptr ||
      (input.repeats1->IsEmpty() && input.repeats2->IsEmpty())) {
    return std::nullopt;
  }
  PointPairs others;
  others.focal1_px = matches.pairs.focal1_px;
  others.focal2_px = matches.pairs.focal2_px;
  for (int n = 0; n < matches.pairs.size(); ++n) {
    if (IsRepeated(input, matches, n)) continue;
    others.x1.push_back(matches.pairs.x1[n]);
    others.x2.push_back(matches.pairs.x2[n]);
    others.covariance1.push_back(matches.pairs.Covariance1(n));
    others.covariance2.push_back(matches.pairs.Covariance2(n));
  }
  EvidenceBeyondRepeats evidence;
  evidence.num_others = others.size();
  evidence.num_repeated = matches.pairs.size() - others.size();
  if (evidence.num_repeated == 0) return std::nullopt;
  evidence.log10_nfa = std::numeric_limits<double>::infinity();
  if (others.size() <= EssentialKernel::kSampleSize) return evidence;
  TwoViewOptions bounded = options;
  bounded.max_threshold_px =
      std::max(2 * PoseSearch::kMinThresholdPx, 2 * pose.point_threshold_px);
  const PoseSearch search(others, {}, SampsonLaw(input), bounded);
  evidence.log10_nfa = search.SupportOf(pose.Cam2FromCam1()).log10_nfa;
  return evidence;
}

}  // namespace lowlap
