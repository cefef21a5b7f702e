#pragma once

#include <cmath>

#include "lowlap/scale/triplet_geometry.h"

namespace lowlap {

/// One log ratio from a triplet read from both ends, log tau_ijk and
/// log tau_kji (which is its negation without noise): the mean of the two,
/// which does not depend on the end called i. Half their disagreement is added
/// to the first-order variance; a hopeless result is degenerate.
inline RatioCandidate CombineEnds(double log_tau_ijk, double log_tau_kji,
                                  double variance) {
  RatioCandidate candidate;
  const double half_difference = 0.5 * (log_tau_ijk + log_tau_kji);
  candidate.log_ratio = 0.5 * (log_tau_ijk - log_tau_kji);
  candidate.log_ratio_stddev =
      std::sqrt(variance + half_difference * half_difference);
  candidate.status = candidate.log_ratio_stddev <= kMaxLogRatioStddev
                         ? CandidateStatus::kValid
                         : CandidateStatus::kDegenerate;
  return candidate;
}

}  // namespace lowlap
