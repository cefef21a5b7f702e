#include "lowlap/two_view/internal/planes/planar_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/a_contrario_ransac.h"
#include "lowlap/two_view/internal/planes/transfer_residual.h"

namespace lowlap {
namespace {

constexpr int kNumPlaneSamples = 200;
constexpr std::size_t kMaxScoredPairs = 500;

// n . x1 of the depth at which a point comes nearest to its match.
double InverseDepth(const RigidTransform& cam2_from_cam1, const Vec3& x1,
                    const Vec3& x2) {
  const Vec3 a = (cam2_from_cam1.rotation * x1).cross(x2);
  const Vec3 b = cam2_from_cam1.translation.cross(x2);
  return -a.dot(b) / b.squaredNorm();
}

}  // namespace

std::optional<ScenePlane> DominantPlane(const RigidTransform& cam2_from_cam1,
                                        const PointPairs& pairs,
                                        const std::vector<int>& indices,
                                        double threshold_px, Random& random) {
  if (indices.size() < 4) return std::nullopt;
  std::vector<double> inverse_depth;
  inverse_depth.reserve(indices.size());
  for (const int i : indices) {
    inverse_depth.push_back(
        InverseDepth(cam2_from_cam1, pairs.x1[i], pairs.x2[i]));
  }
  const auto members = [&](const Vec3& normal, std::size_t count) {
    const TransferResidual residual(cam2_from_cam1, normal, pairs);
    std::vector<int> found;
    for (std::size_t k = 0; k < count; ++k) {
      if (std::abs(residual.Along(indices[k])) <= threshold_px) {
        found.push_back(indices[k]);
      }
    }
    return found;
  };

  const std::size_t num_scored = std::min(indices.size(), kMaxScoredPairs);
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
  // Gauss-Newton on the errors of the members.
  ScenePlane plane{*best, {}};
  for (int iteration = 0; iteration < 5; ++iteration) {
    const TransferResidual residual(cam2_from_cam1, plane.normal, pairs);
    Mat3 information = Mat3::Zero();
    Vec3 gradient = Vec3::Zero();
    Vec3 by_normal;
    for (const int i : members(plane.normal, indices.size())) {
      const double error_px = residual.Along(i, &by_normal);
      information += by_normal * by_normal.transpose();
      gradient += error_px * by_normal;
    }
    const Vec3 refined = plane.normal - information.ldlt().solve(gradient);
    if (!refined.allFinite()) break;
    plane.normal = refined;
  }
  plane.inliers = members(plane.normal, indices.size());
  std::sort(plane.inliers.begin(), plane.inliers.end());
  return plane;
}

std::optional<RigidTransform> OtherPlanarMotion(
    const RigidTransform& cam2_from_cam1, const Vec3& plane_normal,
    const Vec3& ray) {
  const Mat3 h = cam2_from_cam1.rotation +
                 cam2_from_cam1.translation * plane_normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(h.transpose() * h);
  const Vec3& squared = solver.eigenvalues();  // ascending; the middle one is 1
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
