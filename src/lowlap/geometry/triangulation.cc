#include "lowlap/geometry/triangulation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "lowlap/geometry/rotation.h"

namespace lowlap {

std::optional<Vec2> RayDepths(const RigidTransform& cam2_from_cam1,
                              const Vec3& bearing1, const Vec3& bearing2) {
  const Vec3 center2 = cam2_from_cam1.Center();
  const Vec3 ray2 = cam2_from_cam1.rotation.transpose() * bearing2;
  const double aa = bearing1.squaredNorm(), bb = ray2.squaredNorm();
  const double ab = bearing1.dot(ray2);
  const double determinant = bearing1.cross(ray2).squaredNorm();
  if (!(determinant > 1e-20 * aa * bb)) return std::nullopt;
  const double ac = bearing1.dot(center2), bc = ray2.dot(center2);
  return Vec2((bb * ac - ab * bc) / determinant,
              (ab * ac - aa * bc) / determinant);
}

std::optional<Vec3> TriangulateMidpoint(const RigidTransform& cam2_from_cam1,
                                        const Vec3& bearing1,
                                        const Vec3& bearing2) {
  const std::optional<Vec2> depths =
      RayDepths(cam2_from_cam1, bearing1, bearing2);
  if (!depths || !((*depths)(0) > 0) || !((*depths)(1) > 0)) {
    return std::nullopt;
  }
  const Vec3 on_ray2 = cam2_from_cam1.Inverse() * Vec3((*depths)(1) * bearing2);
  return Vec3(0.5 * ((*depths)(0) * bearing1 + on_ray2));
}

std::optional<Vec3> TriangulatePoint(
    const std::vector<RigidTransform>& cams_from_world,
    const std::vector<Vec3>& bearings) {
  if (cams_from_world.size() < 2 || bearings.size() != cams_from_world.size()) {
    return std::nullopt;
  }
  Mat3 normal = Mat3::Zero();
  Vec3 rhs = Vec3::Zero();
  for (std::size_t n = 0; n < bearings.size(); ++n) {
    const Vec3 ray =
        (cams_from_world[n].rotation.transpose() * bearings[n]).normalized();
    const Mat3 across = Mat3::Identity() - ray * ray.transpose();
    normal += across;
    rhs += across * cams_from_world[n].Center();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(normal);
  if (!(eigen.eigenvalues()(0) > 1e-14 * eigen.eigenvalues()(2))) {
    return std::nullopt;
  }
  Vec3 point = eigen.eigenvectors() *
               eigen.eigenvalues().cwiseInverse().asDiagonal() *
               eigen.eigenvectors().transpose() * rhs;

  constexpr int kIterations = 5;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Mat3 hessian = Mat3::Zero();
    Vec3 gradient = Vec3::Zero();
    for (std::size_t n = 0; n < bearings.size(); ++n) {
      const Vec3 x = cams_from_world[n] * point;
      if (!(x.z() > 0)) return std::nullopt;
      const Vec2 residual =
          x.head<2>() / x.z() - bearings[n].head<2>() / bearings[n].z();
      Eigen::Matrix<double, 2, 3> projection;
      projection << 1, 0, -x.x() / x.z(), 0, 1, -x.y() / x.z();
      const Eigen::Matrix<double, 2, 3> jacobian =
          projection * cams_from_world[n].rotation / x.z();
      hessian += jacobian.transpose() * jacobian;
      gradient += jacobian.transpose() * residual;
    }
    const Vec3 step = hessian.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    point -= step;
    if (step.norm() <= 1e-12 * (1.0 + point.norm())) break;
  }
  for (const RigidTransform& cam_from_world : cams_from_world) {
    if (!((cam_from_world * point).z() > 0)) return std::nullopt;
  }
  return point;
}

std::optional<PluckerLine> TriangulateLine(
    const std::vector<RigidTransform>& cams_from_world,
    const std::vector<Vec3>& normals, double min_angle_rad) {
  const std::size_t count = normals.size();
  if (count < 2 || cams_from_world.size() != count) return std::nullopt;
  // The direction is the null vector of the world normals; a point of the line
  // is then the least-squares meeting of the planes nearest to the cameras.
  Mat3 scatter = Mat3::Zero();
  Vec3 mean_center = Vec3::Zero();
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 normal = cams_from_world[n].rotation.transpose() * normals[n];
    scatter += normal * normal.transpose();
    mean_center += cams_from_world[n].Center() / static_cast<double>(count);
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(scatter);
  const double sine = std::sin(min_angle_rad);
  // Two planes at angle a have the middle eigenvalue 1 - |cos a| ~ a^2 / 2.
  if (!(eigen.eigenvalues()(1) > 0.5 * sine * sine)) return std::nullopt;
  const Vec3 direction = eigen.eigenvectors().col(0);
  const Eigen::Matrix<double, 3, 2> basis = eigen.eigenvectors().rightCols<2>();
  Mat2 hessian = Mat2::Zero();
  Vec2 rhs = Vec2::Zero();
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 normal = cams_from_world[n].rotation.transpose() * normals[n];
    const Vec2 row = basis.transpose() * normal;
    hessian += row * row.transpose();
    rhs += row * normal.dot(cams_from_world[n].Center() - mean_center);
  }
  const Vec3 point = mean_center + basis * hessian.ldlt().solve(rhs);
  if (!point.allFinite()) return std::nullopt;
  return PluckerLine::FromPointAndDirection(point, direction);
}

double TriangulationAngle(const std::vector<RigidTransform>& cams_from_world,
                          const Vec3& point_in_world) {
  double largest = 0;
  for (std::size_t a = 0; a < cams_from_world.size(); ++a) {
    const Vec3 ray_a = point_in_world - cams_from_world[a].Center();
    for (std::size_t b = a + 1; b < cams_from_world.size(); ++b) {
      largest = std::max(
          largest,
          AngleBetween(ray_a, point_in_world - cams_from_world[b].Center()));
    }
  }
  return largest;
}

}  // namespace lowlap
