#pragma once

#include <memory>
#include <optional>
#include <string>

#include "lowlap/scale/evidence/evidence_kind.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// Points seen in all three views (TripletView::points), by TripletPointSolver
/// and PointResiduals.
class TrifocalPointKind : public EvidenceKind {
 public:
  std::string Name() const override { return "points"; }
  std::unique_ptr<Evidence> Gather(const TripletView& triplet) const override;
};

/// Lines seen in all three views (TripletView::lines). The error is the mean
/// distance of the two end points observed in k to the projection of the
/// infinite line from (i, j), and likewise from (k, j) into i; the mean of the
/// two.
class TrifocalLineKind : public EvidenceKind {
 public:
  std::string Name() const override { return "lines"; }
  std::unique_ptr<Evidence> Gather(const TripletView& triplet) const override;
};

/// The tau that turns the projection of a line into camera k closest to the
/// observed one (Salaün et al. 2017, section 4, with signs and frames
/// corrected).
///
/// (d, m) the line from views (i, j) at lambda_i = 1; the normal of its
/// interpretation plane in k is v + tau w with
///   v = R_k m,  w = t_k x (R_k d),  u = the observed normal in k,
/// and tau = ClosestDirection(u, v, w). Degenerate: the line lies in an
/// epipolar plane of either pair. Negative: tau < 0 or behind camera j.
std::optional<double> TrifocalLineTau(const TripletGeometry& geometry,
                                      const TripletLine& line,
                                      CandidateStatus* status);

/// The same read from both ends, combined in the log. The standard deviation is
/// to first order from all six end points, each moving across its segment by
/// its stddev_px (differences).
RatioCandidate TrifocalLineRatio(const TripletGeometry& geometry,
                                 const TripletLine& line);

}  // namespace lowlap
