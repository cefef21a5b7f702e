#pragma once

#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"

namespace lowlap {

/// The least NFA over all log ratios of [low, high], within the range of the
/// candidates' own ratios, by an interval sweep (no sampling, no seed).
///
/// For a threshold of the ladder, the ratios for which a candidate is an inlier
/// form few intervals. Their ends, sorted and swept once (robust/
/// interval_sweep.h), give the counts of all kinds at every ratio; a unit of
/// several pairs is counted once, by the union of their intervals. Between two
/// ends the NFA changes with the densities of the background alone
/// (ratio_density.h), whose logs are linear on their grid, so that the ends of
/// a segment are where it is least; both are tried, 0.1 % inside the segment,
/// and its middle, since single precision errors tell the ends of narrow
/// segments no better.
///
/// Only windows that can hold the optimum are swept: over a window, every error
/// has a least and a most possible value (Evidence::Bound), the
/// least ones bound the counts from above, and these the NFA from below. The
/// window with the least bound is halved until the errors that cross a
/// threshold in it are few, and then swept; the search ends when no bound is
/// below the best NFA that was found. Every candidate is scored again with the
/// exact counts at its ratio, which is what is returned.
///
/// The ends of an interval are found by regula falsi, to 1e-5 of the threshold,
/// from the stationary points of the error, which is taken as monotone in
/// between.
/// Tolerance: the returned log10 NFA is never above that of any candidate's
/// ratio, and within 1 % (0.05 near 0) of that of any ratio (tests/scale).
///
/// There must be a hypothesis in [low, high].
RatioOptimum SweepRatios(const RatioSupport& support,
                         const RatioNfaCriterion& criterion, double low,
                         double high);
/// The same over all hypotheses, of which there must be one.
RatioOptimum SweepRatios(const RatioSupport& support,
                         const RatioNfaCriterion& criterion);

}  // namespace lowlap
