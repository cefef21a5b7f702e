#include "lowlap/scale/ratio_residuals.h"

#include <cmath>
#include <limits>

#include "lowlap/geometry/plucker_line.h"
#include "lowlap/geometry/triangulation.h"
#include "lowlap/scale/coplanar_ratio.h"
#include "lowlap/scale/trifocal_line.h"

namespace lowlap {
namespace {

// Below this share of its value at the feature's own ratio, a depth counts as
// behind the camera; the error then comes out huge.
constexpr float kMinDepth = 1e-7f;

using Column = std::vector<float>;

Eigen::Map<const Eigen::ArrayXf> View(const Column& column) {
  return {column.data(), static_cast<Eigen::Index>(column.size())};
}

Eigen::Map<const Eigen::ArrayXf> View(const Column& column, int count) {
  return {column.data(), static_cast<Eigen::Index>(count)};
}

void Push(Column& column, double value) {
  column.push_back(static_cast<float>(value));
}

// (v + tau w) as a projection into a view that observes `observed`.
void PushPointSide(Column* column, const Vec3& v, const Vec3& w,
                   const Vec3& observed, double focal_px, double tau) {
  const double depth = v.z() + tau * w.z();
  const Vec3 v1 = v / depth, w1 = w / depth;
  Push(column[0], focal_px * (v1.x() - observed.x() * v1.z()));
  Push(column[1], focal_px * (w1.x() - observed.x() * w1.z()));
  Push(column[2], focal_px * (v1.y() - observed.y() * v1.z()));
  Push(column[3], focal_px * (w1.y() - observed.y() * w1.z()));
  Push(column[4], v1.z());
  Push(column[5], w1.z());
}

auto PointSide(const Column* c, float tau) {
  return ((View(c[0]) + tau * View(c[1])).square() +
          (View(c[2]) + tau * View(c[3])).square())
             .sqrt() /
         (View(c[4]) + tau * View(c[5])).cwiseMax(kMinDepth);
}

void PushLineSide(Column* column, const Vec3& v, const Vec3& w,
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

auto LineSide(const Column* c, float tau) {
  return ((View(c[0]) + tau * View(c[1])).abs() +
          (View(c[2]) + tau * View(c[3])).abs()) /
         ((View(c[4]) + tau * View(c[5])).square() +
          (View(c[6]) + tau * View(c[7])).square())
             .sqrt()
             .cwiseMax(kMinDepth);
}

// (v + tau w) as a projection into a view that observes the line `normal`.
void PushTransferSide(Column* column, const Vec3& v, const Vec3& w,
                      const Vec3& normal, double focal_px, double tau) {
  const double depth = v.z() + tau * w.z();
  const double to_px = focal_px / (normal.head<2>().norm() * depth);
  Push(column[0], to_px * normal.dot(v));
  Push(column[1], to_px * normal.dot(w));
  Push(column[2], v.z() / depth);
  Push(column[3], w.z() / depth);
}

auto TransferSide(const Column* c, float tau, int n) {
  return (View(c[0], n) + tau * View(c[1], n)).abs() /
         (View(c[2], n) + tau * View(c[3], n)).cwiseMax(kMinDepth);
}

}  // namespace

void PointResiduals::Add(const TripletGeometry& geometry,
                         const TrifocalPoint& point, double log_ratio) {
  const double tau = std::exp(log_ratio);
  const RigidTransform& cami = geometry.cami_from_camj;
  const RigidTransform& camk = geometry.camk_from_camj;
  const Vec3 from_i = TriangulateMidpoint(cami, point.in_j, point.in_i)
                          .value_or(Vec3(Vec3::Zero()));
  const Vec3 from_k = TriangulateMidpoint(camk, point.in_j, point.in_k)
                          .value_or(Vec3(Vec3::Zero()));
  PushPointSide(column_, camk.rotation * from_i, camk.translation, point.in_k,
                geometry.focal_k_px, tau);
  // The scene in i times tau: the projection is the same.
  PushPointSide(column_ + kSide, cami.translation, cami.rotation * from_k,
                point.in_i, geometry.focal_i_px, tau);
}

void PointResiduals::Evaluate(double tau, float* errors_px) const {
  const float t = static_cast<float>(tau);
  Eigen::Map<Eigen::ArrayXf>(errors_px, size()) =
      0.5f * (PointSide(column_, t) + PointSide(column_ + kSide, t));
}

void LineResiduals::Add(const TripletGeometry& geometry,
                        const TrifocalLine& line, double log_ratio) {
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

void LineResiduals::Evaluate(double tau, float* errors_px) const {
  const float t = static_cast<float>(tau);
  Eigen::Map<Eigen::ArrayXf>(errors_px, size()) =
      0.25f * (LineSide(column_, t) + LineSide(column_ + kSide, t));
}

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

void TransferResiduals::Evaluate(double tau, int count,
                                 float* errors_px) const {
  const float t = static_cast<float>(tau);
  Eigen::Map<Eigen::ArrayXf>(errors_px, count) =
      0.5f * (TransferSide(column_, t, count) +
              TransferSide(column_ + kSide, t, count));
}

void PlaneResiduals::Add(const TripletGeometry& geometry, const MatchedLine& a,
                         const MatchedLine& b, double log_ratio) {
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
    for (Column& column : column_) {
      Push(column, std::numeric_limits<double>::infinity());
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
    Push(column_[axis], to_px * ab0(axis));
    Push(column_[3 + axis], to_px * ab1(axis));
    Push(column_[6 + axis], to_px * ba0(axis));
    Push(column_[9 + axis], to_px * ba1(axis));
  }
}

void PlaneResiduals::Evaluate(double tau, int count, float* errors_px) const {
  const float t = static_cast<float>(tau);
  for (int n = 0; n < count; ++n) {
    const auto at = [&](int column) {
      return column_[column][n] + t * column_[column + 3][n];
    };
    const float depth_ab = at(2), depth_ba = at(8);
    if (!(depth_ab > kMinDepth) || !(depth_ba > kMinDepth)) {
      errors_px[n] = std::numeric_limits<float>::infinity();
      continue;
    }
    const float dx = at(0) / depth_ab - at(6) / depth_ba;
    const float dy = at(1) / depth_ab - at(7) / depth_ba;
    errors_px[n] = std::sqrt(dx * dx + dy * dy);
  }
}

}  // namespace lowlap
