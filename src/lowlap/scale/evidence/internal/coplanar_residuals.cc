#include "lowlap/scale/evidence/internal/coplanar_residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lowlap/geometry/plucker_line.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"

namespace lowlap {
namespace {

// (v + tau w) as a projection into a view that observes the line `normal`.
void PushTransferSide(ResidualColumn* column, const Vec3& v, const Vec3& w,
                      const Vec3& normal, double focal_px, double tau) {
  const double depth = v.z() + tau * w.z();
  const double to_px = focal_px / (normal.head<2>().norm() * depth);
  Push(column[0], to_px * normal.dot(v));
  Push(column[1], to_px * normal.dot(w));
  Push(column[2], v.z() / depth);
  Push(column[3], w.z() / depth);
  const double least = -normal.dot(v) / normal.dot(w);
  Push(column[4], std::isfinite(least) ? least : tau);
}

}  // namespace

void TransferResiduals::Add(const TripletGeometry& geometry,
                            const MatchedLine& a, const MatchedLine& b,
                            double log_ratio) {
  const double tau = std::exp(log_ratio);
  const RigidTransform& cami = geometry.cami_from_camj;
  const RigidTransform& camk = geometry.camk_from_camj;
  const Vec3& normal_a = a.in_neighbor.segment.normal;
  const Vec3& normal_b = b.in_neighbor.segment.normal;
  const Vec3 x = CrossingInMiddle(a.in_middle.segment, b.in_middle.segment)
                     .value_or(Vec3(Vec3::UnitZ()));
  const Vec3 on_a = DepthOnPlane(cami, normal_a, x) * x;
  const Vec3 on_b = DepthOnPlane(camk, normal_b, x) * x;
  PushTransferSide(column_, camk.rotation * on_a, camk.translation, normal_b,
                   geometry.focal_k_px, tau);
  PushTransferSide(column_ + kSide, cami.translation, cami.rotation * on_b,
                   normal_a, geometry.focal_i_px, tau);
}

void ClosestPointResiduals::Add(const TripletGeometry& geometry,
                                const MatchedLine& a, const MatchedLine& b,
                                double log_ratio) {
  CandidateStatus status;
  const PluckerLine line_a =
      LineInMiddle(geometry.cami_from_camj, a.in_middle.segment,
                   a.in_neighbor.segment, &status)
          .value_or(PluckerLine());
  const PluckerLine line_b =
      LineInMiddle(geometry.camk_from_camj, b.in_middle.segment,
                   b.in_neighbor.segment, &status)
          .value_or(PluckerLine());
  const Vec3 n = line_a.direction.cross(line_b.direction);
  const double n2 = n.squaredNorm();
  if (!(n2 > 1e-18)) {
    for (ResidualColumn& column : column_) {
      column.push_back(std::numeric_limits<float>::infinity());
    }
    return;
  }
  const Vec3 foot_a = line_a.FootPoint(), foot_b = line_b.FootPoint();
  // P = p0 + tau p1 for either point.
  const Vec3 along_a = line_b.direction.cross(n) / n2;
  const Vec3 along_b = line_a.direction.cross(n) / n2;
  const Vec3 ab0 = foot_a - foot_a.dot(along_a) * line_a.direction;
  const Vec3 ab1 = foot_b.dot(along_a) * line_a.direction;
  const Vec3 ba0 = -foot_a.dot(along_b) * line_b.direction;
  const Vec3 ba1 = foot_b + foot_b.dot(along_b) * line_b.direction;
  const double scale = std::abs((ab0 + std::exp(log_ratio) * ab1).z()) + 1e-300;
  for (int axis = 0; axis < 3; ++axis) {
    const double to_px = (axis < 2 ? geometry.focal_j_px : 1.0) / scale;
    column_[axis].push_back(static_cast<float>(to_px * ab0(axis)));
    column_[3 + axis].push_back(static_cast<float>(to_px * ab1(axis)));
    column_[6 + axis].push_back(static_cast<float>(to_px * ba0(axis)));
    column_[9 + axis].push_back(static_cast<float>(to_px * ba1(axis)));
  }
}

float ClosestPointResiduals::ErrorOf(double tau, int index) const {
  const float t = static_cast<float>(tau);
  const auto at = [&](int column) {
    return column_[column][index] + t * column_[column + 3][index];
  };
  const float depth_ab = at(2), depth_ba = at(8);
  if (!(depth_ab > kMinDepth) || !(depth_ba > kMinDepth)) {
    return std::numeric_limits<float>::infinity();
  }
  const float dx = at(0) / depth_ab - at(6) / depth_ba;
  const float dy = at(1) / depth_ab - at(7) / depth_ba;
  return std::sqrt(dx * dx + dy * dy);
}

void ClosestPointResiduals::Evaluate(double tau, int count,
                                     float* errors_px) const {
  for (int n = 0; n < count; ++n) errors_px[n] = ErrorOf(tau, n);
}

void ClosestPointResiduals::Bound(double tau_low, double tau_high,
                                  float* least_px, float* most_px) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float ends[2] = {static_cast<float>(tau_low),
                         static_cast<float>(tau_high)};
  for (int n = 0; n < size(); ++n) {
    // A coordinate of either point is monotone between its poles.
    const auto at = [&](int column, float tau) {
      return column_[column][n] + tau * column_[column + 3][n];
    };
    const auto in_front = [&](float tau) {
      return at(2, tau) > kMinDepth && at(8, tau) > kMinDepth;
    };
    float least = 0, most = kInfinity;
    if (!std::isfinite(column_[2][n]))
      least = kInfinity;  // parallel in space
    else if (in_front(ends[0]) && in_front(ends[1])) {
      most = 0;
      for (const int axis : {0, 1}) {
        float ab[2], ba[2];
        for (const int end : {0, 1}) {
          ab[end] = at(axis, ends[end]) / at(2, ends[end]);
          ba[end] = at(6 + axis, ends[end]) / at(8, ends[end]);
        }
        const auto [ab_low, ab_high] = std::minmax(ab[0], ab[1]);
        const auto [ba_low, ba_high] = std::minmax(ba[0], ba[1]);
        const float gap = std::max({0.0f, ab_low - ba_high, ba_low - ab_high});
        const float reach = std::max(ab_high - ba_low, ba_high - ab_low);
        least += gap * gap;
        most += reach * reach;
      }
      least = std::sqrt(least);
      most = std::sqrt(most);
    }
    if (least_px != nullptr) least_px[n] = Lowered(least);
    if (most_px != nullptr) most_px[n] = Raised(most);
  }
}

int ClosestPointResiduals::StationaryPoints(int index, double* taus) const {
  // Where either coordinate of the difference would vanish if the depths stood
  // still at their values for the feature's own ratio.
  for (const int axis : {0, 1}) {
    taus[axis] = -(column_[axis][index] - column_[6 + axis][index]) /
                 (column_[3 + axis][index] - column_[9 + axis][index]);
  }
  return 2;
}

}  // namespace lowlap
