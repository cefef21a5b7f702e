#include "lowlap/geometry/plucker_line.h"

#include <cmath>

namespace lowlap {

PluckerLine PluckerLine::FromPoints(const Vec3& a, const Vec3& b) {
  return FromPointAndDirection(a, b - a);
}

PluckerLine PluckerLine::FromPointAndDirection(const Vec3& point,
                                               const Vec3& direction) {
  PluckerLine line;
  line.direction = direction.normalized();
  line.moment = point.cross(line.direction);
  return line;
}

Vec3 PluckerLine::ClosestPointTo(const Vec3& point) const {
  return FootPoint() + direction * direction.dot(point);
}

PluckerLine operator*(const RigidTransform& target_from_source,
                      const PluckerLine& line_in_source) {
  PluckerLine line;
  line.direction = target_from_source.rotation * line_in_source.direction;
  line.moment = target_from_source.rotation * line_in_source.moment +
                target_from_source.translation.cross(line.direction);
  return line;
}

std::optional<PluckerLine> LineFromTwoViews(
    const RigidTransform& cam2_from_cam1, const Vec3& l1, const Vec3& l2,
    double min_sine) {
  const Vec3 q = cam2_from_cam1.rotation.transpose() * l2;
  const Vec3 cross = l1.cross(q);
  const double length = cross.norm();
  if (!(length > min_sine * l1.norm() * q.norm())) return std::nullopt;
  // The line lies in both planes: X.l1 = 0 and X.q = b.q.
  PluckerLine line;
  line.direction = cross / length;
  line.moment = (q.dot(cam2_from_cam1.Center()) / length) * l1;
  return line;
}

std::optional<Vec3> ClosestPointOnLine(const PluckerLine& on,
                                       const PluckerLine& to, double min_sine) {
  const Vec3 n = on.direction.cross(to.direction);
  const double n2 = n.squaredNorm();
  if (!(n2 > min_sine * min_sine)) return std::nullopt;
  const Vec3 foot = on.FootPoint();
  const Vec3 between = to.FootPoint() - foot;
  return foot + (between.cross(to.direction).dot(n) / n2) * on.direction;
}

double LineDistance(const PluckerLine& a, const PluckerLine& b) {
  const Vec3 n = a.direction.cross(b.direction);
  const Vec3 between = b.FootPoint() - a.FootPoint();
  const double sine = n.norm();
  if (sine < 1e-9) return between.cross(a.direction).norm();
  return std::abs(between.dot(n)) / sine;
}

std::optional<Vec3> ClosestPointToRay(const PluckerLine& line,
                                      const Vec3& bearing, double min_sine) {
  return ClosestPointOnLine(
      line, PluckerLine::FromPointAndDirection(Vec3::Zero(), bearing),
      min_sine);
}

}  // namespace lowlap
