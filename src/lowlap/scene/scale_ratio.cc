#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

const char* RatioVerdictName(RatioVerdict verdict) {
  switch (verdict) {
    case RatioVerdict::kMeaningful:
      return "meaningful";
    case RatioVerdict::kNotMeaningful:
      return "not_meaningful";
    case RatioVerdict::kNoCandidates:
      return "no_candidates";
  }
  return "unknown";
}

bool operator==(const ScaleRatio& a, const ScaleRatio& b) {
  return a.views == b.views && a.verdict == b.verdict &&
         a.log_ratio == b.log_ratio &&
         a.log_ratio_stddev == b.log_ratio_stddev &&
         a.log10_nfa == b.log10_nfa && a.second_mode == b.second_mode &&
         a.points == b.points && a.lines == b.lines &&
         a.coplanar == b.coplanar &&
         a.num_rejected_negative == b.num_rejected_negative &&
         a.coplanar_inliers == b.coplanar_inliers;
}

}  // namespace lowlap
