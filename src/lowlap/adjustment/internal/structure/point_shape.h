#pragma once

#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

struct PointTrackState;

/// The direction in which a point is least well localised, and by how much
/// (ViewFeatures::point_covariances).
struct PointShape {
  Vec2 weak_direction = Vec2::UnitX();
  double log_variance_ratio = 0;  // ln of weak over strong; 0: round

  /// (xx, xy, yy) of the covariance.
  static PointShape FromCovariance(const Vec3& covariance);

  /// W with W cov W^T = I for the variances 1 across the weak direction and
  /// ratio^exponent along it.
  Mat2 Whitening(double exponent) const;
};

/// How far the images bear out the shapes: the exponent a, in [0, 1], of
///   E r^2 = s^2 ratio^a
/// for the errors r along the weak directions, by regression of ln r^2 on
/// ln ratio over the landmarks of three or more poses. Where texture is rich, a
/// point on an edge is as good as another (a near 0); on the grain of wood it
/// slides (a near 1). With few such landmarks the exponent stays near one half.
double EstimateShapeExponent(const CameraSet& cameras,
                             const std::vector<PointTrackState>& points);

/// Sets the whitening of every candidate.
void WhitenPoints(double exponent, std::vector<PointTrackState>* points);

}  // namespace lowlap
