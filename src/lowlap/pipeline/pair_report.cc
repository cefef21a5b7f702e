#include "lowlap/pipeline/pair_report.h"

#include <algorithm>

#include "lowlap/core/format.h"

namespace lowlap {

std::string ExplainNoPose(const std::vector<PairReport>& pairs) {
  const std::string none = "no pair of views has a relative pose";
  if (pairs.empty()) return none + ", for none has matches";
  const PairReport& best = *std::max_element(
      pairs.begin(), pairs.end(), [](const PairReport& a, const PairReport& b) {
        return a.num_point_matches + a.num_line_matches <
               b.num_point_matches + b.num_line_matches;
      });
  return none +
         Format(
             "; of %zu, views %u and %u match most (%d points, %d "
             "lines): ",
             pairs.size(), static_cast<unsigned>(best.views.first),
             static_cast<unsigned>(best.views.second), best.num_point_matches,
             best.num_line_matches) +
         best.reason;
}

}  // namespace lowlap
