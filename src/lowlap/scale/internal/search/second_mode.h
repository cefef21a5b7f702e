#pragma once

#include <optional>
#include <vector>

#include "lowlap/scale/internal/criterion/ratio_nfa.h"

namespace lowlap {

/// Where sorted values lie closest, by halves of the values that are as short
/// as possible (Robertson and Cryer 1974). There must be one.
double HalfSampleMode(const std::vector<double>& sorted);

/// The ratio that the candidates which disagree with `mode` by more than 6
/// standard deviations would choose: where their own ratios lie closest. None
/// unless it is meaningful (log10 NFA < 0), and parted from the mode by a ratio
/// between the two whose log10 NFA is higher by a tenth of the mode's, and by 1
/// at least. This costs three evaluations of the NFA; RatioProfile looks at
/// every ratio.
std::optional<RatioOptimum> FindSecondMode(const RatioSupport& support,
                                           const RatioNfaCriterion& criterion,
                                           const RatioOptimum& mode);

}  // namespace lowlap
