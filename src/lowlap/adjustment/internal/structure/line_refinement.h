#pragma once

#include <Eigen/Core>
#include <vector>

#include "lowlap/adjustment/internal/costs/segment_rays.h"
#include "lowlap/geometry/rigid_transform.h"

namespace lowlap {

/// A segment in a posed camera.
struct LineMeasurement {
  RigidTransform cam_from_world;
  const SegmentRays* rays = nullptr;
  double weight = 1;
};

/// Half the sum of squared end point distances (px^2) of the line p + s d; with
/// B = TangentBasis(d), J^T J and J^T r by the four unknowns (a, b) of
///   p' = p + B a,  d' = (d + B b) / |d + B b|.
/// `gradient` may be null.
double LineNormalEquations(const std::vector<LineMeasurement>& measurements,
                           const Vec3& point, const Vec3& direction,
                           Eigen::Matrix4d* hessian, Vec4* gradient);

/// Levenberg-Marquardt on these; never makes the sum larger.
void RefineLine(const std::vector<LineMeasurement>& measurements, Vec3* point,
                Vec3* direction);

}  // namespace lowlap
