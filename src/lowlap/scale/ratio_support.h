#pragma once

#include <vector>

#include "lowlap/robust/threshold_ladder.h"
#include "lowlap/scale/ratio_residuals.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

enum class FeatureKind { kPoint, kLine, kCoplanar };

/// A log ratio that one feature asks for, and which feature.
struct Hypothesis {
  double log_ratio = 0;
  double log_ratio_stddev = 0;
  FeatureKind kind = FeatureKind::kPoint;
  int index = 0;  // within its kind, in the order of RatioSupport's features
};

/// Inliers of one tau per threshold of the ladder. An inlier pair makes a line
/// of (i, j) and one of (j, k) inliers: the error of a line is the least over
/// its partners.
struct SupportCounts {
  LadderCounts points{};
  LadderCounts lines{};
  LadderCounts coplanar_first{};  // lines of (i, j)
  LadderCounts coplanar_last{};   // lines of (j, k)
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
  /// Lines of (i, j), and of (j, k), in at least one pair.
  int num_coplanar_first() const { return static_cast<int>(partners_.size()); }
  int num_coplanar_last() const {
    return static_cast<int>(partners_last_.size());
  }
  int num_rejected_negative() const { return num_rejected_negative_; }

  /// The features of a kind at their own ratio, in the order of their index.
  const std::vector<RatioCandidate>& Ratios(FeatureKind kind) const;
  /// The index of a feature in TripletView::points, or lines.
  int PointOf(int index) const { return point_of_[index]; }
  int LineOf(int index) const { return line_of_[index]; }
  /// Indices into TripletView::lines_ij and lines_jk of a pair.
  const CoplanarPairCandidate& Pair(int index) const { return pairs_[index]; }

  /// Errors in pixels of all features of a kind at one ratio.
  void Errors(FeatureKind kind, double log_ratio,
              std::vector<float>* errors_px) const;
  SupportCounts Count(double log_ratio, SupportWorkspace* workspace) const;
  /// The counts of one kind; those of the others are left at zero.
  SupportCounts CountKind(FeatureKind kind, double log_ratio,
                          SupportWorkspace* workspace) const;

 private:
  void AddPoints(const TripletView& triplet);
  void AddLines(const TripletView& triplet);
  void AddPairs(const TripletView& triplet);
  void CountInto(FeatureKind kind, double log_ratio,
                 SupportWorkspace* workspace, SupportCounts* counts) const;
  void CountCoplanar(SupportWorkspace* workspace, SupportCounts* counts) const;

  CoplanarResidual coplanar_residual_;
  PointResiduals points_;
  LineResiduals lines_;
  TransferResiduals transfer_;
  PlaneResiduals plane_;
  std::vector<RatioCandidate> point_ratios_;
  std::vector<RatioCandidate> line_ratios_;
  std::vector<RatioCandidate> pair_ratios_;
  std::vector<int> point_of_;
  std::vector<int> line_of_;
  std::vector<CoplanarPairCandidate> pairs_;
  // Of a pair, the rank of its lines among those in at least one pair.
  std::vector<int> pair_first_;
  std::vector<int> pair_last_;
  std::vector<int> partners_;
  std::vector<int> partners_last_;
  std::vector<Hypothesis> hypotheses_;
  int num_rejected_negative_ = 0;
};

}  // namespace lowlap
