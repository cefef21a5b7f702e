#include "lowlap/scale/evidence/internal/line_in_middle.h"

#include <cmath>

namespace lowlap {

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

}  // namespace lowlap
