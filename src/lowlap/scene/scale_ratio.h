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

/// What one kind of evidence says in one triplet.
struct KindSupport {
  std::string kind;  // its name; see EvidenceKind
  int candidates = 0;
  int inliers = 0;
  double log10_nfa = 0;  // at the chosen ratio; 0 = nothing to say
  /// The a-contrario threshold of the inliers, in the kind's own unit (pixels
  /// as a rule).
  double threshold_px = 0;
  /// Of the information on the ratio (1 / variance, without what the relative
  /// poses add). The kinds' add up to 1; 0 for all: not known.
  double information_share = 0;
  /// Inliers from which on they bear each other out.
  int min_agreeing = 2;

  friend bool operator==(const KindSupport& a, const KindSupport& b);
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
  /// The ratio that the candidates which disagree would choose, if it is
  /// meaningful too; see FindSecondMode.
  std::optional<RatioMode> second_mode;
  /// The kinds that were asked, each once, in the order of tables.
  std::vector<KindSupport> kinds;
  /// Candidates dropped because they would need a negative depth.
  int num_rejected_negative = 0;
  std::vector<CoplanarInlier> coplanar_inliers;

  /// Null if the kind was not asked.
  const KindSupport* FindKind(const std::string& kind) const;
  /// Of all kinds.
  int NumInliers() const;
  /// Whether the inliers of kinds alike bear each other out
  /// (KindSupport::min_agreeing).
  bool HasAgreement() const;
  /// Whether most candidates of kinds alike are inliers. Where two surfaces of
  /// different depth are neighbours in the middle view, many pairs of their
  /// lines are coplanar at one wrong ratio, which is not chance; but they are
  /// few of all pairs.
  bool HasMajority() const;

  /// The interval that holds the true log ratio with a probability of 95 %, if
  /// the mode is right.
  double IntervalLow() const { return log_ratio - 1.96 * log_ratio_stddev; }
  double IntervalHigh() const { return log_ratio + 1.96 * log_ratio_stddev; }

  friend bool operator==(const ScaleRatio& a, const ScaleRatio& b);
};

}  // namespace lowlap
