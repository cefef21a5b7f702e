#include "lowlap/scene/scale_ratio.h"

#include <algorithm>

namespace lowlap {
namespace {

// Candidates and inliers of the kinds whose inliers bear those of `kind` out.
KindSupport SumOfKindsAlike(const std::vector<KindSupport>& kinds,
                            const KindSupport& kind) {
  KindSupport sum;
  for (const KindSupport& support : kinds) {
    if (support.min_agreeing != kind.min_agreeing) continue;
    sum.candidates += support.candidates;
    sum.inliers += support.inliers;
  }
  return sum;
}

}  // namespace

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

bool operator==(const KindSupport& a, const KindSupport& b) {
  return a.kind == b.kind && a.candidates == b.candidates &&
         a.inliers == b.inliers && a.log10_nfa == b.log10_nfa &&
         a.threshold_px == b.threshold_px &&
         a.information_share == b.information_share &&
         a.min_agreeing == b.min_agreeing;
}

const KindSupport* ScaleRatio::FindKind(const std::string& kind) const {
  for (const KindSupport& support : kinds) {
    if (support.kind == kind) return &support;
  }
  return nullptr;
}

int ScaleRatio::NumInliers() const {
  int inliers = 0;
  for (const KindSupport& support : kinds) inliers += support.inliers;
  return inliers;
}

bool ScaleRatio::HasAgreement() const {
  return std::any_of(kinds.begin(), kinds.end(), [&](const KindSupport& kind) {
    return SumOfKindsAlike(kinds, kind).inliers >= kind.min_agreeing;
  });
}

bool ScaleRatio::HasMajority() const {
  return std::any_of(kinds.begin(), kinds.end(), [&](const KindSupport& kind) {
    const KindSupport sum = SumOfKindsAlike(kinds, kind);
    return 2 * sum.inliers > sum.candidates;
  });
}

bool operator==(const ScaleRatio& a, const ScaleRatio& b) {
  return a.views == b.views && a.verdict == b.verdict &&
         a.log_ratio == b.log_ratio &&
         a.log_ratio_stddev == b.log_ratio_stddev &&
         a.log10_nfa == b.log10_nfa && a.second_mode == b.second_mode &&
         a.kinds == b.kinds &&
         a.num_rejected_negative == b.num_rejected_negative &&
         a.coplanar_inliers == b.coplanar_inliers;
}

}  // namespace lowlap
