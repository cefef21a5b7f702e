#pragma once

#include <array>
#include <memory>
#include <vector>

#include "lowlap/robust/threshold_ladder.h"
#include "lowlap/scale/evidence/evidence_kind.h"

namespace lowlap {

/// A log ratio that one candidate asks for, and which one.
struct Hypothesis {
  double log_ratio = 0;
  double log_ratio_stddev = 0;
  int kind = 0;   // as in RatioSupport
  int index = 0;  // of the candidate within its kind
};

/// Errors of all candidates, by kind.
using KindErrors = std::vector<std::vector<float>>;

/// Inlier units of one tau per threshold of the ladder, by counter.
using SupportCounts = std::vector<LadderCounts>;

/// Buffers of RatioSupport's evaluations, one per thread.
struct SupportWorkspace {
  std::vector<float> errors;
  std::array<std::vector<float>, 2> least;
  SupportCounts counts;
};

/// The kinds of evidence that say something about tau, with the ratios of their
/// candidates, and their errors at any other. Kinds are numbered in the order
/// of the evidence, those without candidates left out; tiers over all kinds in
/// a row; and counters likewise: one for each side of each tier.
class RatioSupport {
 public:
  explicit RatioSupport(const TripletEvidence& evidence);

  int num_kinds() const { return static_cast<int>(kinds_.size()); }
  const Evidence& kind(int kind) const { return *kinds_[kind].evidence; }
  /// The place of the kind in TripletEvidence::kinds.
  int PlaceOf(int kind) const { return kinds_[kind].place; }
  int FirstTier(int kind) const { return kinds_[kind].first_tier; }
  int FirstCounter(int kind) const { return kinds_[kind].first_counter; }
  int num_tiers() const { return num_tiers_; }
  int num_counters() const { return num_counters_; }
  /// The first tier of its kind that holds a candidate.
  int TierOf(int kind, int index) const;

  /// Sorted by log ratio (then kind, then index).
  const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }
  /// The log ratios of the first `count` candidates of a kind, sorted.
  std::vector<double> SortedLogRatios(int kind, int count) const;

  /// Bounds of the errors over an interval of log ratios; either output may be
  /// null.
  void Bound(double low, double high, KindErrors* least,
             KindErrors* most) const;
  /// The counts at a ratio; they are the workspace's.
  const SupportCounts& Count(double log_ratio,
                             SupportWorkspace* workspace) const;
  /// The counts for given errors.
  const SupportCounts& Count(const KindErrors& errors,
                             SupportWorkspace* workspace) const;
  /// Those of the tiers of one kind up to `last_tier`, from its first counter.
  void CountKind(int kind, double log_ratio, int last_tier,
                 SupportWorkspace* workspace, LadderCounts* counts) const;

 private:
  struct OfKind {
    std::shared_ptr<const Evidence> evidence;
    int place = 0;
    int first_tier = 0;
    int first_counter = 0;
  };
  void CountErrors(int kind, const float* errors, int last_tier,
                   SupportWorkspace* workspace, LadderCounts* counts) const;

  std::vector<OfKind> kinds_;
  int num_tiers_ = 0;
  int num_counters_ = 0;
  std::vector<Hypothesis> hypotheses_;
};

}  // namespace lowlap
