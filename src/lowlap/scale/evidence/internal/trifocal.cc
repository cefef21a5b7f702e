#include "lowlap/scale/evidence/internal/trifocal.h"

#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/geometry/internal/closest_direction.h"
#include "lowlap/robust/internal/nfa.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"
#include "lowlap/scale/evidence/internal/residual_arrays.h"
#include "lowlap/scale/evidence/internal/residual_evidence.h"
#include "lowlap/scale/evidence/internal/triplet_points.h"
#include "lowlap/scale/internal/candidate_limits.h"

namespace lowlap {
namespace {

class TrifocalPoints : public ResidualEvidence<PointResiduals> {
 public:
  explicit TrifocalPoints(const TripletView& triplet)
      : image_area_px2_(triplet.image_area_px2) {
    const TripletPointSolver solver(triplet.geometry);
    residuals_.Reserve(static_cast<int>(triplet.points.size()));
    for (std::size_t n = 0; n < triplet.points.size(); ++n) {
      const TripletPoint& point = triplet.points[n];
      RatioCandidate ratio;
      const auto midpoints = solver.Midpoints(point, &ratio.status);
      if (midpoints) ratio = solver.Ratio(point, *midpoints);
      if (!AddCandidate(ratio)) continue;
      residuals_.Add(triplet.geometry, point, *midpoints, ratio.log_ratio);
      point_of_.push_back(n);
    }
  }

  double NumTests() const override { return size(); }
  NfaTerm PaperTerm(const LogFactorials& factorials,
                    const LadderCounts* counts) const override {
    return PaperPointTerm(factorials, size(), *counts, image_area_px2_);
  }
  // The deviations are those of one pixel.
  double PriorCount() const override { return 0.25; }

 protected:
  CandidateDetail DetailOf(const TripletView& triplet, int n) const override {
    return {triplet.points[point_of_[n]].in_j.head<2>(), {}};
  }
  RatioCandidate RatioIn(const TripletView& triplet,
                         const TripletGeometry& geometry,
                         int n) const override {
    return TripletPointSolver(geometry).Ratio(triplet.points[point_of_[n]]);
  }

 private:
  double image_area_px2_;
  std::vector<std::size_t> point_of_;  // in the triplet
};

TripletLine Swapped(const TripletLine& line) {
  return {line.segment_in_middle, line.in_k, line.in_j, line.in_i};
}

// (log tau_ijk - log tau_kji) / 2.
std::optional<double> CombinedLogTau(const TripletGeometry& geometry,
                                     const TripletLine& line,
                                     CandidateStatus* status) {
  const std::optional<double> ijk = TrifocalLineTau(geometry, line, status);
  if (!ijk) return std::nullopt;
  const std::optional<double> kji =
      TrifocalLineTau(geometry.Swapped(), Swapped(line), status);
  if (!kji) return std::nullopt;
  return 0.5 * (std::log(*ijk) - std::log(*kji));
}

// The segment with one end moved across it, in normalised coordinates.
NormalizedSegment Moved(const NormalizedSegment& segment, bool start,
                        double by) {
  NormalizedSegment moved = segment;
  Vec3& end = start ? moved.start : moved.end;
  end.head<2>() += by * segment.normal.head<2>().normalized();
  moved.normal = moved.start.cross(moved.end).normalized();
  return moved;
}

void PushLineSide(ResidualColumn* column, const Vec3& v, const Vec3& w,
                  const NormalizedSegment& observed, double focal_px,
                  double tau) {
  const double length = (v + tau * w).head<2>().norm();
  const Vec3 v1 = v / length, w1 = w / length;
  Push(column[0], focal_px * observed.start.dot(v1));
  Push(column[1], focal_px * observed.start.dot(w1));
  Push(column[2], focal_px * observed.end.dot(v1));
  Push(column[3], focal_px * observed.end.dot(w1));
  Push(column[4], v1.x());
  Push(column[5], w1.x());
  Push(column[6], v1.y());
  Push(column[7], w1.y());
}

// The mean distance of the two end points from a projected line, in one view.
struct LineSide {
  static constexpr int kColumns = 8;
  static auto At(const ResidualColumn* c, float tau, int n) {
    return 0.5f *
           ((First(c[0], n) + tau * First(c[1], n)).abs() +
            (First(c[2], n) + tau * First(c[3], n)).abs()) /
           ((First(c[4], n) + tau * First(c[5], n)).square() +
            (First(c[6], n) + tau * First(c[7], n)).square())
               .sqrt()
               .cwiseMax(kMinDepth);
  }
  static float Of(const ResidualColumn* c, float tau, int n) {
    return 0.5f *
           (std::abs(c[0][n] + tau * c[1][n]) +
            std::abs(c[2][n] + tau * c[3][n])) /
           Length(c, tau, n);
  }
  static float Length(const ResidualColumn* c, float tau, int n) {
    const float x = c[4][n] + tau * c[5][n], y = c[6][n] + tau * c[7][n];
    return std::max(kMinDepth, std::sqrt(x * x + y * y));
  }
};

// The least and the most of a side of one line in an interval.
std::pair<float, float> BoundLineSide(const ResidualColumn* c, float low,
                                      float high, int n) {
  float numerator[2] = {0, 0};
  for (int end = 0; end < 4; end += 2) {
    const float a = c[end][n] + low * c[end + 1][n];
    const float b = c[end][n] + high * c[end + 1][n];
    if ((a > 0) == (b > 0)) numerator[0] += std::min(std::abs(a), std::abs(b));
    numerator[1] += std::max(std::abs(a), std::abs(b));
  }
  const float speed = c[5][n] * c[5][n] + c[7][n] * c[7][n];
  const float least_at =
      speed > 0 ? -(c[4][n] * c[5][n] + c[6][n] * c[7][n]) / speed : low;
  const auto length = [&](float tau) { return LineSide::Length(c, tau, n); };
  return {numerator[0] / std::max(length(low), length(high)),
          numerator[1] / length(std::clamp(least_at, low, high))};
}

// Both sides have two end points that may meet the line at two ratios, so that
// bounds and stationary points are of its own.
class LineResiduals : public TwoSidedResiduals<LineSide> {
 public:
  void Add(const TripletGeometry& geometry, const TripletLine& line,
           double log_ratio);
  void Bound(double tau_low, double tau_high, float* least_px,
             float* most_px) const;
  int StationaryPoints(int index, double* taus) const;
};

void LineResiduals::Add(const TripletGeometry& geometry,
                        const TripletLine& line, double log_ratio) {
  const double tau = std::exp(log_ratio);
  const RigidTransform& cami = geometry.cami_from_camj;
  const RigidTransform& camk = geometry.camk_from_camj;
  CandidateStatus status;
  const PluckerLine from_i =
      LineInMiddle(cami, line.in_j.segment, line.in_i.segment, &status)
          .value_or(PluckerLine());
  const PluckerLine from_k =
      LineInMiddle(camk, line.in_j.segment, line.in_k.segment, &status)
          .value_or(PluckerLine());
  PushLineSide(column_, camk.rotation * from_i.moment,
               camk.translation.cross(camk.rotation * from_i.direction),
               line.in_k.segment, geometry.focal_k_px, tau);
  PushLineSide(column_ + kSide,
               cami.translation.cross(cami.rotation * from_k.direction),
               cami.rotation * from_k.moment, line.in_i.segment,
               geometry.focal_i_px, tau);
}

void LineResiduals::Bound(double tau_low, double tau_high, float* least_px,
                          float* most_px) const {
  const float low = static_cast<float>(tau_low);
  const float high = static_cast<float>(tau_high);
  for (int n = 0; n < size(); ++n) {
    const auto [least_k, most_k] = BoundLineSide(column_, low, high, n);
    const auto [least_i, most_i] = BoundLineSide(column_ + kSide, low, high, n);
    if (least_px != nullptr) least_px[n] = Lowered(0.25f * (least_k + least_i));
    if (most_px != nullptr) most_px[n] = Raised(0.25f * (most_k + most_i));
  }
}

int LineResiduals::StationaryPoints(int index, double* taus) const {
  int num_points = 0;
  for (const int side : {0, kSide}) {
    for (const int end : {0, 2}) {
      taus[num_points++] =
          -column_[side + end][index] / column_[side + end + 1][index];
    }
  }
  return num_points;
}

class TrifocalLines : public ResidualEvidence<LineResiduals> {
 public:
  explicit TrifocalLines(const TripletView& triplet)
      : image_area_px2_(triplet.image_area_px2),
        image_diagonal_px_(triplet.image_diagonal_px) {
    for (std::size_t n = 0; n < triplet.lines.size(); ++n) {
      const TripletLine& line = triplet.lines[n];
      const RatioCandidate ratio = TrifocalLineRatio(triplet.geometry, line);
      if (!AddCandidate(ratio)) continue;
      residuals_.Add(triplet.geometry, line, ratio.log_ratio);
      line_of_.push_back(n);
    }
  }

  NfaTerm PaperTerm(const LogFactorials& factorials,
                    const LadderCounts* counts) const override {
    return PaperLineTerm(factorials, size(), *counts, image_area_px2_,
                         image_diagonal_px_);
  }

 protected:
  CandidateDetail DetailOf(const TripletView& triplet, int n) const override {
    const NormalizedSegment& segment = triplet.lines[line_of_[n]].in_j.segment;
    return {Vec2(0.5 * (segment.start + segment.end).head<2>()), {}};
  }
  RatioCandidate RatioIn(const TripletView& triplet,
                         const TripletGeometry& geometry,
                         int n) const override {
    return TrifocalLineRatio(geometry, triplet.lines[line_of_[n]]);
  }

 private:
  double image_area_px2_, image_diagonal_px_;
  std::vector<std::size_t> line_of_;  // in the triplet
};

}  // namespace

std::unique_ptr<Evidence> TrifocalPointKind::Gather(
    const TripletView& triplet) const {
  return std::make_unique<TrifocalPoints>(triplet);
}

std::optional<double> TrifocalLineTau(const TripletGeometry& geometry,
                                      const TripletLine& line,
                                      CandidateStatus* status) {
  const std::optional<PluckerLine> in_j = LineInMiddle(
      geometry.cami_from_camj, line.in_j.segment, line.in_i.segment, status);
  if (!in_j) return std::nullopt;
  *status = CandidateStatus::kDegenerate;
  if (!line.in_k.segment.IsValid()) return std::nullopt;
  const Mat3& rotation = geometry.camk_from_camj.rotation;
  const Vec3 v = rotation * in_j->moment;
  const Vec3 w =
      geometry.camk_from_camj.translation.cross(rotation * in_j->direction);
  if (!(w.norm() > 1e-9)) return std::nullopt;  // parallel to the baseline
  const std::optional<double> tau =
      ClosestDirection(line.in_k.segment.normal, v, w);
  if (!tau) return std::nullopt;
  if (!(*tau > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  *status = CandidateStatus::kValid;
  return tau;
}

RatioCandidate TrifocalLineRatio(const TripletGeometry& geometry,
                                 const TripletLine& line) {
  RatioCandidate candidate;
  const std::optional<double> log_tau =
      CombinedLogTau(geometry, line, &candidate.status);
  if (!log_tau) return candidate;
  candidate.status = CandidateStatus::kDegenerate;
  double variance = 0;
  for (ObservedSegment TripletLine::*view :
       {&TripletLine::in_i, &TripletLine::in_j, &TripletLine::in_k}) {
    const double focal_px = view == &TripletLine::in_i   ? geometry.focal_i_px
                            : view == &TripletLine::in_j ? geometry.focal_j_px
                                                         : geometry.focal_k_px;
    for (const bool start : {true, false}) {
      constexpr double kStep = 0.1;  // of a standard deviation
      TripletLine moved = line;
      (moved.*view).segment = Moved((line.*view).segment, start,
                                    kStep * (line.*view).stddev_px / focal_px);
      CandidateStatus status;
      const std::optional<double> log_tau_moved =
          CombinedLogTau(geometry, moved, &status);
      if (!log_tau_moved) return candidate;
      const double change = (*log_tau_moved - *log_tau) / kStep;
      variance += change * change;
    }
  }
  candidate.log_ratio = *log_tau;
  candidate.log_ratio_stddev = std::sqrt(variance);
  if (candidate.log_ratio_stddev <= kMaxLogRatioStddev) {
    candidate.status = CandidateStatus::kValid;
  }
  return candidate;
}

std::unique_ptr<Evidence> TrifocalLineKind::Gather(
    const TripletView& triplet) const {
  return std::make_unique<TrifocalLines>(triplet);
}

}  // namespace lowlap
