#pragma once

#include <optional>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"

namespace lowlap {

/// A plane normal . X = 1 in camera 1, and the matches that lie on it.
struct ScenePlane {
  Vec3 normal = Vec3::Zero();
  std::vector<int> inliers;  // ascending
};

/// The plane that holds most of the matches named by `indices`, inliers of the
/// motion: RANSAC on three matches. They lie on it if their TransferResidual
/// along the epipolar line is at most `threshold_px`. nullopt: fewer than 4
/// matches, or no sample with a plane.
std::optional<ScenePlane> DominantPlane(const RigidTransform& cam2_from_cam1,
                                        const PointPairs& pairs,
                                        const std::vector<int>& indices,
                                        double threshold_px, Random& random);

/// The other motion that moves the points of a plane in the same way: H = R +
/// t n^T has two decompositions with the plane in front of camera 1 (Ma,
/// Soatto, Košecká, Sastry, "An Invitation to 3-D Vision", section 5.3.3). The
/// translation comes with unit length. nullopt where there is only one: t
/// parallel to the normal, or no translation. `ray` is a viewing ray of camera
/// 1 to a point of the plane, which decides what is in front.
std::optional<RigidTransform> OtherPlanarMotion(
    const RigidTransform& cam2_from_cam1, const Vec3& plane_normal,
    const Vec3& ray);

}  // namespace lowlap
