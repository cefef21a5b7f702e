#pragma once

#include <string>
#include <vector>

#include "lowlap/core/ids.h"

namespace lowlap {

enum class RatioVerdict {
  kMeaningful,     // log10_nfa < 0: use it
  kNotMeaningful,  // an optimum exists, but chance explains it as well
  kNoCandidates,   // nothing of the enabled kinds constrains the triplet
};

const char* RatioVerdictName(RatioVerdict verdict);

/// Counts of one kind of constraint in one triplet.
struct KindSupport {
  int candidates = 0;
  int inliers = 0;
  double log10_nfa = 0;     // at the chosen ratio; 0 = nothing to say
  double threshold_px = 0;  // the a-contrario threshold of the inliers

  friend bool operator==(const KindSupport& a, const KindSupport& b) {
    return a.candidates == b.candidates && a.inliers == b.inliers &&
           a.log10_nfa == b.log10_nfa && a.threshold_px == b.threshold_px;
  }
};

/// A pair of lines found coplanar: `line_in_first` is a match of (first,
/// middle), given by its segment in the middle view; `line_in_last` one of
/// (middle, last), likewise.
struct CoplanarInlier {
  FeatureIndex line_in_first = 0;
  FeatureIndex line_in_last = 0;

  friend bool operator==(const CoplanarInlier& a, const CoplanarInlier& b) {
    return a.line_in_first == b.line_in_first &&
           a.line_in_last == b.line_in_last;
  }
};

/// The relative scale of two relative poses that share a camera:
///   log_ratio = log( lambda(middle, last) / lambda(first, middle) ).
struct ScaleRatio {
  ViewTriplet views;
  RatioVerdict verdict = RatioVerdict::kNoCandidates;
  double log_ratio = 0;
  double log_ratio_stddev = 0;
  double log10_nfa = 0;  // total over the kinds
  KindSupport points;
  KindSupport lines;
  KindSupport coplanar;
  /// Candidates dropped because they would need a negative depth.
  int num_rejected_negative = 0;
  std::vector<CoplanarInlier> coplanar_inliers;

  friend bool operator==(const ScaleRatio& a, const ScaleRatio& b);
};

}  // namespace lowlap
