#pragma once

#include <vector>

#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

/// Which candidates of a kind are inliers.
struct InlierThreshold {
  double threshold = 0;    // 0 leaves the kind out
  int num_candidates = 0;  // that are considered, from the nearest tier on
};
/// By kind of the support.
using InlierThresholds = std::vector<InlierThreshold>;

/// A ratio with the triplet's names and candidate counts, and no verdict yet.
ScaleRatio EmptyRatio(const TripletView& triplet,
                      const TripletEvidence& evidence);

/// Writes an NFA into a ratio of EmptyRatio.
void RecordNfa(const RatioNfa& nfa, const RatioSupport& support,
               ScaleRatio* ratio);

/// Refines a log ratio (RefineRatio) on every candidate of the kinds with a
/// threshold that is anywhere near: a threshold that is best for telling right
/// from wrong is too tight for an average, which it ties to where it started,
/// and makes the noise look too small. The inliers only say how large the noise
/// is to begin with.
/// Fills log_ratio and log_ratio_stddev (with the part that comes from the
/// relative poses, where their covariance is known), the shares of information,
/// and for the refined ratio the inlier counts, thresholds and inliers
/// (Evidence::RecordInliers) of a ratio of EmptyRatio. A ratio that no
/// candidate bears out stays as it is, with the deviation kMaxLogRatioStddev.
void RefineOnInliers(const TripletView& triplet, const RatioSupport& support,
                     const InlierThresholds& thresholds, double log_ratio,
                     ScaleRatio* ratio);

}  // namespace lowlap
