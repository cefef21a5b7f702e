#include "lowlap/scale/scale_estimator.h"

#include <cmath>
#include <limits>

#include "lowlap/geometry/rotation.h"
#include "lowlap/scale/a_contrario_scale.h"
#include "lowlap/scale/fixed_threshold_scale.h"

namespace lowlap {
namespace {

bool IsPositive(double value) { return std::isfinite(value) && value > 0; }

bool IsUnitTransform(const RigidTransform& transform) {
  return RotationDefect(transform.rotation) < 1e-6 &&
         std::abs(transform.translation.norm() - 1.0) < 1e-6;
}

}  // namespace

Status ScaleOptions::Validate() const {
  if (!use_points && !use_lines && !use_coplanar) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "no kind of feature is enabled for the scale ratios");
  }
  if (!IsPositive(threshold_px)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the inlier threshold must be positive");
  }
  if (num_neighbors < 1) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the number of neighbours must be at least 1");
  }
  return {};
}

Status CheckTriplet(const TripletView& triplet) {
  const TripletGeometry& geometry = triplet.geometry;
  if (!IsUnitTransform(geometry.cami_from_camj) ||
      !IsUnitTransform(geometry.camk_from_camj)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "a relative pose of the triplet is not a rotation with a "
                     "unit direction");
  }
  if (!IsPositive(geometry.focal_i_px) || !IsPositive(geometry.focal_j_px) ||
      !IsPositive(geometry.focal_k_px) || !IsPositive(triplet.image_area_px2) ||
      !IsPositive(triplet.image_diagonal_px)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "a focal length or the image size of the triplet is not "
                     "positive");
  }
  return {};
}

std::unique_ptr<ScaleEstimator> MakeScaleEstimator(
    const ScaleOptions& options) {
  if (options.criterion == ScaleCriterion::kFixedThreshold) {
    return std::make_unique<FixedThresholdScaleEstimator>(options);
  }
  return std::make_unique<AContrarioScaleEstimator>(options);
}

}  // namespace lowlap
