#include "lowlap/scale/evidence/internal/ratio_residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lowlap/geometry/plucker_line.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/trifocal_line.h"

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

using Values = Eigen::ArrayXf;

// Where a side lies least in the interval, for a minimum at column `turn`.
auto Clamped(const Column& turn, int count, float low, float high) {
  return View(turn, count).cwiseMax(low).cwiseMin(high);
}

// (v + tau w) as a projection into a view that observes `observed`.
void PushPointSide(Column* column, const Vec3& v, const Vec3& w,
                   const Vec3& observed, double focal_px, double tau) {
  const double inverse_depth = 1.0 / (v.z() + tau * w.z());
  const Vec3 v1 = inverse_depth * v, w1 = inverse_depth * w;
  const Vec2 a = focal_px * (v1 - observed * v1.z()).head<2>();
  const Vec2 b = focal_px * (w1 - observed * w1.z()).head<2>();
  Push(column[0], a.x());
  Push(column[1], b.x());
  Push(column[2], a.y());
  Push(column[3], b.y());
  Push(column[4], v1.z());
  Push(column[5], w1.z());
  // Of |a + tau b| / (c + tau d).
  const double least = (w1.z() * a.squaredNorm() - v1.z() * a.dot(b)) /
                       (v1.z() * b.squaredNorm() - w1.z() * a.dot(b));
  Push(column[6], std::isfinite(least) ? least : tau);
}

template <class Tau>
auto PointDistanceAt(const Column* c, const Tau& tau) {
  return ((View(c[0]) + tau * View(c[1])).square() +
          (View(c[2]) + tau * View(c[3])).square())
      .sqrt();
}

template <class Tau>
auto PointDepthAt(const Column* c, const Tau& tau) {
  return (View(c[4]) + tau * View(c[5])).cwiseMax(kMinDepth);
}

template <class Tau>
auto PointSideAt(const Column* c, const Tau& tau) {
  return PointDistanceAt(c, tau) / PointDepthAt(c, tau);
}

float PointSideOf(const Column* c, float tau, int n) {
  const float x = c[0][n] + tau * c[1][n], y = c[2][n] + tau * c[3][n];
  return std::sqrt(x * x + y * y) /
         std::max(kMinDepth, c[4][n] + tau * c[5][n]);
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

float LineSideOf(const Column* c, float tau, int n) {
  const float x = c[4][n] + tau * c[5][n], y = c[6][n] + tau * c[7][n];
  return (std::abs(c[0][n] + tau * c[1][n]) +
          std::abs(c[2][n] + tau * c[3][n])) /
         std::max(kMinDepth, std::sqrt(x * x + y * y));
}

// The least and the most of a side of one line in an interval.
std::pair<float, float> BoundLineSide(const Column* c, float low, float high,
                                      int n) {
  float numerator[2] = {0, 0};
  for (int end = 0; end < 4; end += 2) {
    const float a = c[end][n] + low * c[end + 1][n];
    const float b = c[end][n] + high * c[end + 1][n];
    if ((a > 0) == (b > 0)) numerator[0] += std::min(std::abs(a), std::abs(b));
    numerator[1] += std::max(std::abs(a), std::abs(b));
  }
  const auto length = [&](float tau) {
    const float x = c[4][n] + tau * c[5][n], y = c[6][n] + tau * c[7][n];
    return std::max(kMinDepth, std::sqrt(x * x + y * y));
  };
  const float speed = c[5][n] * c[5][n] + c[7][n] * c[7][n];
  const float turn =
      speed > 0 ? -(c[4][n] * c[5][n] + c[6][n] * c[7][n]) / speed : low;
  return {numerator[0] / std::max(length(low), length(high)),
          numerator[1] / length(std::clamp(turn, low, high))};
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
  const double least = -normal.dot(v) / normal.dot(w);
  Push(column[4], std::isfinite(least) ? least : tau);
}

template <class Tau>
auto TransferSideAt(const Column* c, const Tau& tau, int n) {
  return (View(c[0], n) + tau * View(c[1], n)).abs() /
         (View(c[2], n) + tau * View(c[3], n)).cwiseMax(kMinDepth);
}

float TransferSideOf(const Column* c, float tau, int n) {
  return std::abs(c[0][n] + tau * c[1][n]) /
         std::max(kMinDepth, c[2][n] + tau * c[3][n]);
}

// A little below or above, for what rounding does to the errors.
constexpr float kRoundingPx = 1e-3f;
constexpr float kRounding = 1e-5f;

float Lowered(float least_px) {
  return std::max(0.0f, least_px * (1 - kRounding) - kRoundingPx);
}
float Raised(float most_px) { return most_px * (1 + kRounding) + kRoundingPx; }

void Widen(int count, float* least_px, float* most_px) {
  using Map = Eigen::Map<Eigen::ArrayXf>;
  if (least_px != nullptr) {
    Map least(least_px, count);
    least = (least * (1 - kRounding) - kRoundingPx).cwiseMax(0.0f);
  }
  if (most_px != nullptr) {
    Map most(most_px, count);
    most = most * (1 + kRounding) + kRoundingPx;
  }
}

}  // namespace

void PointResiduals::Reserve(int count) {
  for (Column& column : column_) column.reserve(count);
}

void PointResiduals::Add(const TripletGeometry& geometry,
                         const TrifocalPoint& point,
                         const TrifocalMidpoints& midpoints, double log_ratio) {
  const double tau = std::exp(log_ratio);
  const RigidTransform& cami = geometry.cami_from_camj;
  const RigidTransform& camk = geometry.camk_from_camj;
  PushPointSide(column_, camk.rotation * midpoints.from_i, camk.translation,
                point.in_k, geometry.focal_k_px, tau);
  // The scene in i times tau: the projection is the same.
  PushPointSide(column_ + kSide, cami.translation,
                cami.rotation * midpoints.from_k, point.in_i,
                geometry.focal_i_px, tau);
}

void PointResiduals::Evaluate(double tau, float* errors_px) const {
  const float t = static_cast<float>(tau);
  const Column* const c = column_;
  const Column* const d = column_ + kSide;
  // The mean of two quotients with one division.
  Eigen::Map<Eigen::ArrayXf>(errors_px, size()) =
      0.5f *
      (PointDistanceAt(c, t) * PointDepthAt(d, t) +
       PointDistanceAt(d, t) * PointDepthAt(c, t)) /
      (PointDepthAt(c, t) * PointDepthAt(d, t));
}

float PointResiduals::ErrorOf(double tau, int index) const {
  const float t = static_cast<float>(tau);
  return 0.5f * (PointSideOf(column_, t, index) +
                 PointSideOf(column_ + kSide, t, index));
}

void PointResiduals::Bound(double tau_low, double tau_high, float* least_px,
                           float* most_px) const {
  const float low = static_cast<float>(tau_low);
  const float high = static_cast<float>(tau_high);
  const Column* const c = column_;
  const Column* const d = column_ + kSide;
  if (least_px != nullptr) {
    Eigen::Map<Values>(least_px, size()) =
        0.5f * (PointSideAt(c, Clamped(c[6], size(), low, high)) +
                PointSideAt(d, Clamped(d[6], size(), low, high)));
  }
  if (most_px != nullptr) {
    Eigen::Map<Values>(most_px, size()) =
        0.5f * (PointSideAt(c, low).cwiseMax(PointSideAt(c, high)) +
                PointSideAt(d, low).cwiseMax(PointSideAt(d, high)));
  }
  Widen(size(), least_px, most_px);
}

int PointResiduals::Turns(int index, double* taus) const {
  taus[0] = column_[6][index];
  taus[1] = column_[kSide + 6][index];
  return 2;
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

float LineResiduals::ErrorOf(double tau, int index) const {
  const float t = static_cast<float>(tau);
  return 0.25f * (LineSideOf(column_, t, index) +
                  LineSideOf(column_ + kSide, t, index));
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

int LineResiduals::Turns(int index, double* taus) const {
  int turn = 0;
  for (const int side : {0, kSide}) {
    for (const int end : {0, 2}) {
      taus[turn++] =
          -column_[side + end][index] / column_[side + end + 1][index];
    }
  }
  return turn;
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
      0.5f * (TransferSideAt(column_, t, count) +
              TransferSideAt(column_ + kSide, t, count));
}

float TransferResiduals::ErrorOf(double tau, int index) const {
  const float t = static_cast<float>(tau);
  return 0.5f * (TransferSideOf(column_, t, index) +
                 TransferSideOf(column_ + kSide, t, index));
}

void TransferResiduals::Bound(double tau_low, double tau_high, int count,
                              float* least_px, float* most_px) const {
  const float low = static_cast<float>(tau_low);
  const float high = static_cast<float>(tau_high);
  const Column* const c = column_;
  const Column* const d = column_ + kSide;
  if (least_px != nullptr) {
    Eigen::Map<Values>(least_px, count) =
        0.5f * (TransferSideAt(c, Clamped(c[4], count, low, high), count) +
                TransferSideAt(d, Clamped(d[4], count, low, high), count));
  }
  if (most_px != nullptr) {
    Eigen::Map<Values>(most_px, count) =
        0.5f * (TransferSideAt(c, low, count)
                    .cwiseMax(TransferSideAt(c, high, count)) +
                TransferSideAt(d, low, count)
                    .cwiseMax(TransferSideAt(d, high, count)));
  }
  Widen(count, least_px, most_px);
}

int TransferResiduals::Turns(int index, double* taus) const {
  taus[0] = column_[4][index];
  taus[1] = column_[kSide + 4][index];
  return 2;
}

}  // namespace lowlap
