#include "lowlap/scale/internal/planes/plane_samples.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lowlap/geometry/internal/closest_direction.h"

namespace lowlap {
namespace {

bool IsUsable(const DepthSample& sample) {
  return std::isfinite(sample.inverse_depth) && sample.inverse_depth > 0 &&
         sample.stddev <= kMaxSampleStddev * sample.inverse_depth;
}

// How many pixels the transfer moves when x moves by a pixel, for rays that are
// not far from the axes; it may be half as many again for oblique ones.
double Magnification(const RigidTransform& camn_from_camj, const Vec3& x,
                     double inverse_depth, double focal_j_px,
                     double focal_n_px) {
  const double depth =
      (camn_from_camj.rotation * x + inverse_depth * camn_from_camj.translation)
          .z();
  return focal_n_px / (focal_j_px * depth);
}

void AddPoint(const RigidTransform& camn_from_camj, double focal_j_px,
              double focal_n_px, const MatchedPoint& point,
              std::vector<DepthSample>* samples) {
  const Vec3 v = camn_from_camj.rotation * point.in_middle;
  const Vec3& w = camn_from_camj.translation;
  const std::optional<double> rho = ClosestDirection(point.in_neighbor, v, w);
  if (!rho || !(*rho > 0)) return;
  const Vec3 y = v + *rho * w;
  if (!(y.z() > 0)) return;
  const Vec2 velocity = (w.head<2>() - (w.z() / y.z()) * y.head<2>()) / y.z();
  DepthSample sample;
  sample.ray = point.in_middle;
  sample.inverse_depth = *rho;
  sample.speed_px = focal_n_px * velocity.norm();
  sample.stddev = std::hypot(1.0, Magnification(camn_from_camj, sample.ray,
                                                *rho, focal_j_px, focal_n_px)) /
                  sample.speed_px;
  sample.feature = point.point_in_middle;
  if (IsUsable(sample)) samples->push_back(sample);
}

// Standard deviation, in units of that of the end points, of a segment across
// itself at the place nearest to y: grows beyond the ends.
double SpreadAt(const NormalizedSegment& segment, const Vec2& y) {
  const Vec2 start = segment.start.head<2>();
  const Vec2 along = segment.end.head<2>() - start;
  const double t = (y - start).dot(along) / along.squaredNorm();
  return std::hypot(1.0 - t, t);
}

void AddLine(const RigidTransform& camn_from_camj, double focal_j_px,
             double focal_n_px, const MatchedLine& line,
             std::vector<DepthSample>* samples) {
  const NormalizedSegment& in_middle = line.in_middle.segment;
  const NormalizedSegment& in_neighbor = line.in_neighbor.segment;
  if (!in_middle.IsValid() || !in_neighbor.IsValid()) return;
  const Vec3 normal = in_neighbor.normal / in_neighbor.normal.head<2>().norm();
  const double across = normal.dot(camn_from_camj.translation);
  std::vector<DepthSample> ends;
  for (const Vec3& end : {in_middle.start, in_middle.end}) {
    const Vec3 v = camn_from_camj.rotation * end;
    DepthSample sample;
    sample.ray = end;
    sample.inverse_depth = -normal.dot(v) / across;
    const Vec3 y = v + sample.inverse_depth * camn_from_camj.translation;
    if (!(y.z() > 0)) return;
    sample.speed_px = focal_n_px * std::abs(across) / y.z();
    const double in_neighbor_px =
        line.in_neighbor.stddev_px * SpreadAt(in_neighbor, y.head<2>() / y.z());
    const double in_middle_px =
        line.in_middle.stddev_px * Magnification(camn_from_camj, end,
                                                 sample.inverse_depth,
                                                 focal_j_px, focal_n_px);
    sample.stddev = std::hypot(in_neighbor_px, in_middle_px) / sample.speed_px;
    sample.feature = line.segment_in_middle;
    sample.is_line = true;
    if (!IsUsable(sample)) return;
    ends.push_back(sample);
  }
  samples->insert(samples->end(), ends.begin(), ends.end());
}

}  // namespace

std::vector<DepthSample> DepthSamples(const RigidTransform& camn_from_camj,
                                      double focal_j_px, double focal_n_px,
                                      const std::vector<MatchedPoint>& points,
                                      const std::vector<MatchedLine>& lines) {
  std::vector<DepthSample> samples;
  for (const MatchedPoint& point : points) {
    AddPoint(camn_from_camj, focal_j_px, focal_n_px, point, &samples);
  }
  for (const MatchedLine& line : lines) {
    AddLine(camn_from_camj, focal_j_px, focal_n_px, line, &samples);
  }
  return samples;
}

}  // namespace lowlap
