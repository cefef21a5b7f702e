#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lowlap/robust/threshold_ladder.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

class LogFactorials;
struct NfaTerm;

/// What counts once among the candidates of one kind of evidence: the candidate
/// itself, or, of pairs, the members of either side, however many pairs a
/// member is part of (its error is the least of theirs). Candidates may come in
/// nested tiers, the surest first, of which a criterion takes the one that says
/// most.
struct EvidenceUnits {
  /// The sizes of a tier, the tiers before it included.
  struct Tier {
    int num_candidates = 0;
    std::array<int, 2> num_units{};
  };
  std::vector<Tier> tiers = std::vector<Tier>(1);
  int num_sides = 1;
  /// Of pairs: the unit of every candidate on either side. Those of a tier are
  /// the first ones.
  std::array<std::vector<int>, 2> of_pair;

  int num_tiers() const { return static_cast<int>(tiers.size()); }
  int Of(int candidate, int side) const {
    return num_sides == 1 ? candidate : of_pair[side][candidate];
  }
};

/// What the refinement of a ratio asks about a candidate.
struct CandidateDetail {
  /// Where in the middle view (normalised) it is: neighbours may err together.
  /// A candidate without a place errs alone.
  std::optional<Vec2> place;
  /// Of pairs: how the log ratio moves with each independent error of either
  /// unit. Pairs that share a unit share its noise. The sum of all squares is
  /// log_ratio_stddev^2.
  std::array<std::array<double, 4>, 2> moves{};
};

/// What one kind of evidence says about the ratio tau of one triplet: a list of
/// candidates, each with the log ratio that it asks for and its deviation, and
/// with an error at every other tau. Errors are counted on the ladder of
/// thresholds (0.125 to 16): pixels as a rule, or another unit in which an
/// error of about 1 is common. Immutable once gathered.
///
/// Only ErrorOf must be written. The functions over all candidates at once have
/// defaults that call it; kinds with many candidates override them.
class Evidence {
 public:
  virtual ~Evidence() = default;

  /// By candidate, all kValid.
  const std::vector<RatioCandidate>& ratios() const { return ratios_; }
  int size() const { return static_cast<int>(ratios_.size()); }
  const EvidenceUnits& units() const { return units_; }
  /// Left out since they would need a negative depth.
  int num_rejected_negative() const { return num_rejected_negative_; }

  /// The error of one candidate at tau (not its logarithm); huge or not finite
  /// where tau is impossible.
  virtual float ErrorOf(double tau, int candidate) const = 0;
  /// The errors of the first `count` candidates.
  virtual void Errors(double tau, int count, float* errors) const;
  /// Bounds of every candidate's errors over [tau_low, tau_high], which close
  /// as the interval shrinks; either output may be null. The default is for
  /// errors that only rise from the candidate's own ratio to both sides.
  virtual void Bound(double tau_low, double tau_high, float* least,
                     float* most) const;
  /// The most stationary points that a candidate may have.
  static constexpr int kMaxStationaryPoints = 4;
  /// The taus, beside the candidate's own ratio, between which its error is
  /// taken as monotone: in no order, some may be negative or infinite. Returns
  /// how many were written.
  virtual int StationaryPoints(int candidate, double* taus) const;

  /// The ratios that the kind adds to those that are tried: ends of intervals
  /// in which a candidate is an inlier. The default is one for each candidate
  /// and threshold; one for each candidate where an interval surrounds its own
  /// ratio, so that the threshold that decides tells the end that counts.
  virtual double NumTests() const;
  /// log10 of the probability that an unrelated unit is an inlier, by step of
  /// the ladder. None: it is measured on the candidates themselves.
  virtual std::optional<LadderProbabilities> Background() const;
  /// The term of the kind in the form of the paper, from the inlier units of
  /// each side in the last tier; the default says nothing (log10 NFA 0).
  virtual NfaTerm PaperTerm(const LogFactorials& factorials,
                            const LadderCounts* counts) const;

  /// How many candidates the stated deviations count as, beforehand, in the
  /// estimate of the noise; small where their unit is nominal.
  virtual double PriorCount() const { return 2; }
  /// Inliers from which on they bear each other out.
  virtual int MinAgreeing() const { return 2; }
  /// Of some candidates; the default has no places and no pairs.
  virtual std::vector<CandidateDetail> Details(
      const TripletView& triplet, const std::vector<int>& candidates) const;
  /// The ratios of some candidates if the relative poses were others; the
  /// default does not depend on them.
  virtual std::vector<RatioCandidate> RatiosIn(
      const TripletView& triplet, const TripletGeometry& geometry,
      const std::vector<int>& candidates) const;
  /// Adds what later stages use of the inliers, beside their number.
  virtual void RecordInliers(const TripletView& triplet,
                             const std::vector<int>& inliers,
                             ScaleRatio* ratio) const;

 protected:
  /// A candidate that is its own unit. False if it is left out: not kValid, a
  /// log ratio that is not finite, a deviation that is not positive.
  bool AddCandidate(const RatioCandidate& ratio);
  /// Pairs are added tier by tier, the surest first, by the members that a kind
  /// numbers as it likes; as units they are numbered as they first occur.
  void StartPairs(int num_tiers);
  bool AddPair(const RatioCandidate& ratio, int tier,
               const std::array<int, 2>& members);
  void RejectNegative(int count) { num_rejected_negative_ += count; }

 private:
  std::vector<RatioCandidate> ratios_;
  EvidenceUnits units_;
  std::array<std::vector<int>, 2> unit_of_member_;  // -1: not yet
  int num_rejected_negative_ = 0;
};

}  // namespace lowlap
