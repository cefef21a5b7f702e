#include "lowlap/robust/internal/a_contrario_ransac.h"

namespace lowlap {

void EarlyBailOut::SetBest(double log10_nfa) {
  share_needed_.resize(ladder_.NumSteps());
  for (int step = 0; step < ladder_.NumSteps(); ++step) {
    share_needed_[step] =
        static_cast<double>(ladder_.InliersToBeat(log10_nfa, step)) /
        static_cast<double>(num_data_);
  }
}

bool EarlyBailOut::MayWin(const std::vector<int>& counts, int num_seen) const {
  if (share_needed_.empty()) return true;
  constexpr double kDeviations = 4;
  int num_inliers = 0;
  for (std::size_t step = 0; step < share_needed_.size(); ++step) {
    num_inliers += counts[step];
    const double share = share_needed_[step];
    if (share > 1) continue;
    const double expected = share * num_seen;
    const double short_by = expected - num_inliers;
    if (short_by <= 0 || short_by * short_by <= kDeviations * kDeviations *
                                                    expected * (1 - share)) {
      return true;
    }
  }
  return false;
}

}  // namespace lowlap
