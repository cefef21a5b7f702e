#pragma once

#include <array>
#include <vector>

#include "lowlap/robust/threshold_ladder.h"
#include "lowlap/scale/evidence/internal/ratio_residuals.h"
#include "lowlap/scale/internal/criterion/support_counts.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

enum class FeatureKind { kPoint, kLine, kCoplanar, kPlanePoint };

inline constexpr std::array<FeatureKind, 4> kFeatureKinds = {
    FeatureKind::kPoint, FeatureKind::kLine, FeatureKind::kCoplanar,
    FeatureKind::kPlanePoint};

/// Errors in pixels of all features, by kind.
using KindErrors = std::array<std::vector<float>, kFeatureKinds.size()>;

/// A log ratio that one feature asks for, and which feature.
struct Hypothesis {
  double log_ratio = 0;
  double log_ratio_stddev = 0;
  FeatureKind kind = FeatureKind::kPoint;
  int index = 0;  // within its kind, in the order of RatioSupport's features
};

/// Buffers of RatioSupport's evaluations, one per thread.
struct SupportWorkspace {
  std::vector<float> errors_px;
  std::vector<float> least_first_px;
  std::vector<float> least_last_px;
};

/// The features of a triplet that say something about tau, with their own
/// ratios, and their errors at any other. Features that are degenerate or ask
/// for a negative depth are left out (the latter are counted).
class RatioSupport {
 public:
  RatioSupport(const TripletView& triplet, const ScaleOptions& options);

  /// Sorted by log ratio (then kind, then index).
  const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }
  int num_points() const { return points_.size(); }
  int num_lines() const { return lines_.size(); }
  int num_pairs() const { return static_cast<int>(pairs_.size()); }
  /// In the order of TripletView::plane_points.
  int num_plane_points() const { return plane_points_.size(); }
  /// Pairs are numbered by tier, so that a tier is the first num_pairs ones.
  const PairTier& Tier(int tier) const { return tiers_[tier]; }
  int TierOfPair(int index) const;
  int num_rejected_negative() const { return num_rejected_negative_; }

  /// The features of a kind at their own ratio, in the order of their index.
  const std::vector<RatioCandidate>& Ratios(FeatureKind kind) const;
  /// The log ratios of the first `count` features of a kind, sorted.
  std::vector<double> SortedLogRatios(FeatureKind kind, int count) const;
  /// The index of a feature in TripletView::points, or lines.
  int PointOf(int index) const { return point_of_[index]; }
  int LineOf(int index) const { return line_of_[index]; }
  /// Indices into TripletView::lines_ij and lines_jk of a pair.
  const CoplanarPairCandidate& Pair(int index) const { return pairs_[index]; }

  /// The ranks of a pair's lines: those of a tier are the first num_first
  /// (num_last) ones.
  int FirstLineOf(int pair) const { return pair_first_[pair]; }
  int LastLineOf(int pair) const { return pair_last_[pair]; }

  /// Errors in pixels of all features of a kind at one ratio.
  void Errors(FeatureKind kind, double log_ratio,
              std::vector<float>* errors_px) const;
  /// The error of one feature at tau (not its logarithm).
  float ErrorOf(FeatureKind kind, int index, double tau) const;
  /// The taus at which one feature's error may turn; see ratio_residuals.h.
  /// Returns how many were written (at most kMaxTurns).
  int Turns(FeatureKind kind, int index, double* taus) const;
  /// Bounds of the errors over an interval of log ratios; either output may be
  /// null.
  void Bound(double low, double high, KindErrors* least_px,
             KindErrors* most_px) const;
  SupportCounts Count(double log_ratio, SupportWorkspace* workspace) const;
  /// The counts for given errors.
  SupportCounts Count(const KindErrors& errors_px,
                      SupportWorkspace* workspace) const;
  LadderCounts CountPoints(double log_ratio, SupportWorkspace* workspace) const;
  LadderCounts CountLines(double log_ratio, SupportWorkspace* workspace) const;
  LadderCounts CountPlanePoints(double log_ratio,
                                SupportWorkspace* workspace) const;
  /// The counts of the tiers up to `last_tier`; the others are left at zero.
  std::array<PairCounts, kPairTiers> CountPairs(
      double log_ratio, int last_tier, SupportWorkspace* workspace) const;

 private:
  void AddPoints(const TripletView& triplet);
  void AddLines(const TripletView& triplet);
  void AddPairs(const TripletView& triplet);
  void AddPlanePoints(const TripletView& triplet);
  void PairErrors(double log_ratio, int num_pairs, float* errors_px) const;
  std::array<PairCounts, kPairTiers> CountPairErrors(
      const float* errors_px, int last_tier, SupportWorkspace* workspace) const;

  CoplanarResidual coplanar_residual_;
  PointResiduals points_;
  LineResiduals lines_;
  TransferResiduals transfer_;
  PlaneResiduals plane_;
  PointResiduals plane_points_;
  std::vector<RatioCandidate> point_ratios_;
  std::vector<RatioCandidate> line_ratios_;
  std::vector<RatioCandidate> pair_ratios_;
  std::vector<RatioCandidate> plane_point_ratios_;
  std::vector<int> point_of_;
  std::vector<int> line_of_;
  std::vector<CoplanarPairCandidate> pairs_;
  // Lines are ranked in the order in which they first occur.
  std::vector<int> pair_first_;
  std::vector<int> pair_last_;
  std::array<PairTier, kPairTiers> tiers_{};
  std::vector<Hypothesis> hypotheses_;
  int num_rejected_negative_ = 0;
};

}  // namespace lowlap
