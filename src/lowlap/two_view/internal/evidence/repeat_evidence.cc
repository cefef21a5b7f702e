#include "lowlap/two_view/internal/evidence/repeat_evidence.h"

#include <limits>
#include <vector>

#include "lowlap/two_view/internal/evidence/partial_evidence.h"

namespace lowlap {
namespace {

/// Crossings of lines have no window of their own.
constexpr double kCrossingScalePx = std::numeric_limits<double>::infinity();

bool IsRepeated(const TwoViewInput& input, const ShuffledMatches& matches,
                int n) {
  const int m = matches.match_of_pair[n];
  if (m == ShuffledMatches::kCrossing) {
    return input.repeats1->Covers(matches.pairs.x1[n], kCrossingScalePx) ||
           input.repeats2->Covers(matches.pairs.x2[n], kCrossingScalePx);
  }
  const FeatureMatch& match = input.point_matches[m];
  return input.repeats1->HasPoint(match.first) ||
         input.repeats2->HasPoint(match.second);
}

}  // namespace

std::optional<std::vector<int>> MatchesBeyondRepeats(
    const TwoViewInput& input, const ShuffledMatches& matches) {
  if (input.repeats1 == nullptr || input.repeats2 == nullptr ||
      (input.repeats1->IsEmpty() && input.repeats2->IsEmpty())) {
    return std::nullopt;
  }
  std::vector<int> others;
  for (int n = 0; n < matches.pairs.size(); ++n) {
    if (!IsRepeated(input, matches, n)) others.push_back(n);
  }
  if (others.size() == matches.match_of_pair.size()) return std::nullopt;
  return others;
}

std::optional<EvidenceBeyondRepeats> FindEvidenceBeyondRepeats(
    const TwoViewInput& input, const ShuffledMatches& matches,
    const RelativePose& pose, const TwoViewOptions& options) {
  const auto others = MatchesBeyondRepeats(input, matches);
  if (!others) return std::nullopt;
  EvidenceBeyondRepeats evidence;
  evidence.num_others = static_cast<int>(others->size());
  evidence.num_repeated = matches.pairs.size() - evidence.num_others;
  evidence.log10_nfa = EvidenceOfSome(input, matches, *others, pose, options);
  return evidence;
}

}  // namespace lowlap
