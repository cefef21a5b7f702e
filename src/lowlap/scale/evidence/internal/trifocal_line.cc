#include "lowlap/scale/evidence/internal/trifocal_line.h"

#include <cmath>

#include "lowlap/geometry/closest_direction.h"

namespace lowlap {
namespace {

TrifocalLine Swapped(const TrifocalLine& line) {
  return {line.segment_in_middle, line.in_k, line.in_j, line.in_i};
}

// (log tau_ijk - log tau_kji) / 2.
std::optional<double> CombinedLogTau(const TripletGeometry& geometry,
                                     const TrifocalLine& line,
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

}  // namespace

double DepthOnPlane(const RigidTransform& camn_from_camj, const Vec3& normal_n,
                    const Vec3& x) {
  const Vec3 q = camn_from_camj.rotation.transpose() * normal_n;
  return q.dot(camn_from_camj.Center()) / q.dot(x);
}

std::optional<PluckerLine> LineInMiddle(const RigidTransform& camn_from_camj,
                                        const NormalizedSegment& in_j,
                                        const NormalizedSegment& in_n,
                                        CandidateStatus* status) {
  *status = CandidateStatus::kDegenerate;
  if (!in_j.IsValid() || !in_n.IsValid()) return std::nullopt;
  const std::optional<PluckerLine> line =
      LineFromTwoViews(camn_from_camj, in_j.normal, in_n.normal);
  if (!line || !(line->moment.norm() > 1e-12)) return std::nullopt;
  const double start_depth =
      DepthOnPlane(camn_from_camj, in_n.normal, in_j.start);
  const double end_depth = DepthOnPlane(camn_from_camj, in_n.normal, in_j.end);
  if (!std::isfinite(start_depth) || !std::isfinite(end_depth)) {
    return std::nullopt;
  }
  if (!(start_depth > 0) || !(end_depth > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  *status = CandidateStatus::kValid;
  return line;
}

std::optional<double> TrifocalLineTau(const TripletGeometry& geometry,
                                      const TrifocalLine& line,
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
                                 const TrifocalLine& line) {
  RatioCandidate candidate;
  const std::optional<double> log_tau =
      CombinedLogTau(geometry, line, &candidate.status);
  if (!log_tau) return candidate;
  candidate.status = CandidateStatus::kDegenerate;
  double variance = 0;
  for (ObservedSegment TrifocalLine::*view :
       {&TrifocalLine::in_i, &TrifocalLine::in_j, &TrifocalLine::in_k}) {
    const double focal_px = view == &TrifocalLine::in_i   ? geometry.focal_i_px
                            : view == &TrifocalLine::in_j ? geometry.focal_j_px
                                                          : geometry.focal_k_px;
    for (const bool start : {true, false}) {
      constexpr double kStep = 0.1;  // of a standard deviation
      TrifocalLine moved = line;
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

}  // namespace lowlap
