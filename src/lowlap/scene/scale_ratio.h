#pragma once

#include <optional>
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
  /// Of the information on the ratio (1 / variance, without what the relative
  /// poses add). The kinds' add up to 1; 0 for all: not known.
  double information_share = 0;

  friend bool operator==(const KindSupport& a, const KindSupport& b) {
    return a.candidates == b.candidates && a.inliers == b.inliers &&
           a.log10_nfa == b.log10_nfa && a.threshold_px == b.threshold_px &&
           a.information_share == b.information_share;
  }
};

/// A ratio that could be meant instead.
struct RatioMode {
  double log_ratio = 0;
  double log10_nfa = 0;

  friend bool operator==(const RatioMode& a, const RatioMode& b) {
    return a.log_ratio == b.log_ratio && a.log10_nfa == b.log10_nfa;
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
  /// The ratio that the features which disagree would choose, if it is
  /// meaningful too; see FindSecondMode.
  std::optional<RatioMode> second_mode;
  KindSupport points;
  KindSupport lines;
  KindSupport coplanar;
  /// Candidates dropped because they would need a negative depth.
  int num_rejected_negative = 0;
  std::vector<CoplanarInlier> coplanar_inliers;

  /// The interval that holds the true log ratio with a probability of 95 %, if
  /// the mode is right.
  double IntervalLow() const { return log_ratio - 1.96 * log_ratio_stddev; }
  double IntervalHigh() const { return log_ratio + 1.96 * log_ratio_stddev; }

  friend bool operator==(const ScaleRatio& a, const ScaleRatio& b);
};

}  // namespace lowlap
