#include "lowlap/two_view/internal/planar_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/a_contrario_ransac.h"

namespace lowlap {
namespace {

constexpr int kNumPlaneSamples = 200;
constexpr std::size_t kMaxScoredMotions = 500;

bool OnPlane(const Mat3& homography, const Vec3& x1, const Vec3& x2,
             double threshold) {
  const Vec3 y = homography * x1;
  if (y.z() <= 0) return false;
  return (y.head<2>() / y.z() - x2.head<2>()).squaredNorm() <=
         threshold * threshold;
}

}  // namespace

std::optional<ScenePlane> DominantPlane(const RigidTransform& cam2_from_cam1,
                                        const PointPairs& pairs,
                                        const std::vector<int>& indices,
                                        double threshold_px, Random& random) {
  if (indices.size() < 4) return std::nullopt;
  const Mat3& r = cam2_from_cam1.rotation;
  const Vec3& t = cam2_from_cam1.translation;
  const double threshold = threshold_px / pairs.focal2_px;
  // x2 ~ R x1 + t (n . x1): n . x1 is the inverse depth that fits best.
  std::vector<double> inverse_depth;
  inverse_depth.reserve(indices.size());
  for (const int i : indices) {
    const Vec3 a = (r * pairs.x1[i]).cross(pairs.x2[i]);
    const Vec3 b = t.cross(pairs.x2[i]);
    inverse_depth.push_back(-a.dot(b) / b.squaredNorm());
  }
  const auto members = [&](const Vec3& normal, std::size_t count) {
    const Mat3 homography = r + t * normal.transpose();
    std::vector<int> positions;
    for (std::size_t k = 0; k < count; ++k) {
      const int i = indices[k];
      if (OnPlane(homography, pairs.x1[i], pairs.x2[i], threshold)) {
        positions.push_back(static_cast<int>(k));
      }
    }
    return positions;
  };

  const std::size_t num_scored = std::min(indices.size(), kMaxScoredMotions);
  std::size_t best_count = 3;
  std::optional<Vec3> best;
  for (int n = 0; n < kNumPlaneSamples; ++n) {
    const auto sample = DrawSample<3>(static_cast<int>(indices.size()), random);
    Mat3 points;
    Vec3 depths;
    for (int k = 0; k < 3; ++k) {
      points.row(k) = pairs.x1[indices[sample[k]]];
      depths[k] = inverse_depth[sample[k]];
    }
    const Vec3 normal = points.partialPivLu().solve(depths);
    if (!normal.allFinite()) continue;
    const std::size_t count = members(normal, num_scored).size();
    if (count > best_count) {
      best_count = count;
      best = normal;
    }
  }
  if (!best) return std::nullopt;
  // Gauss-Newton on the transfer error of the members.
  for (int iteration = 0; iteration < 5; ++iteration) {
    Mat3 information = Mat3::Zero();
    Vec3 gradient = Vec3::Zero();
    for (const int k : members(*best, indices.size())) {
      const Vec3& x1 = pairs.x1[indices[k]];
      const Vec3 y = r * x1 + t * best->dot(x1);
      const Vec2 transferred = y.head<2>() / y.z();
      const Vec2 error = transferred - pairs.x2[indices[k]].head<2>();
      // d transferred / d n = slope x1^T.
      const Vec2 slope = (t.head<2>() - transferred * t.z()) / y.z();
      information += slope.squaredNorm() * x1 * x1.transpose();
      gradient += slope.dot(error) * x1;
    }
    const Vec3 refined = *best - information.ldlt().solve(gradient);
    if (!refined.allFinite()) break;
    best = refined;
  }
  ScenePlane plane;
  plane.normal = *best;
  for (const int k : members(plane.normal, indices.size())) {
    plane.inliers.push_back(indices[k]);
  }
  return plane;
}

std::optional<RigidTransform> OtherPlanarMotion(
    const RigidTransform& cam2_from_cam1, const Vec3& plane_normal,
    const Vec3& ray) {
  const Mat3 h = cam2_from_cam1.rotation +
                 cam2_from_cam1.translation * plane_normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(h.transpose() * h);
  const Vec3 squared = solver.eigenvalues();  // ascending; the middle one is 1
  const double low = std::max(0.0, 1 - squared[0]);
  const double high = std::max(0.0, squared[2] - 1);
  // Without a translation both vanish; with t parallel to n, one of them.
  if (std::min(low, high) < 1e-12) return std::nullopt;
  const Vec3 v1 = solver.eigenvectors().col(2);
  const Vec3 v2 = solver.eigenvectors().col(1);
  const Vec3 v3 = solver.eigenvectors().col(0);

  // Two directions of the plane pair whose lengths H keeps; each pairs with v2
  // to span a candidate of the plane.
  std::optional<RigidTransform> other;
  double largest_change = 0;
  for (const double sign : {1.0, -1.0}) {
    const Vec3 u =
        (std::sqrt(low) * v1 + sign * std::sqrt(high) * v3).normalized();
    Mat3 before;
    Mat3 after;
    before << v2, u, v2.cross(u);
    after << h * v2, h * u, (h * v2).cross(h * u);
    const Mat3 rotation = NearestRotation(after * before.transpose());
    Vec3 normal = v2.cross(u);
    if (normal.dot(ray) < 0) normal = -normal;
    const Vec3 translation = (h - rotation) * normal;
    const double length = translation.norm();
    if (!(length > 0)) continue;
    const RigidTransform motion{rotation, translation / length};
    const double change =
        RotationAngleBetween(rotation, cam2_from_cam1.rotation) +
        AngleBetween(motion.translation, cam2_from_cam1.translation);
    if (change > largest_change) {
      largest_change = change;
      other = motion;
    }
  }
  return other;
}

}  // namespace lowlap
