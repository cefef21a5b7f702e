#include "lowlap/scale/scale_estimator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/evidence/evidence_registry.h"

namespace lowlap {
namespace {

bool IsPositive(double value) { return std::isfinite(value) && value > 0; }

// Wider than what a valid scene keeps to, since relative poses are inverted.
bool IsUnitTransform(const RigidTransform& transform) {
  constexpr double kTolerance = 1e-5;
  return RotationDefect(transform.rotation) <= kTolerance &&
         std::abs(transform.translation.norm() - 1.0) <= kTolerance;
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

}  // namespace

bool ScaleOptions::Asks(const std::string& feature) const {
  return features.empty() ||
         std::find(features.begin(), features.end(), feature) != features.end();
}

Status ScaleOptions::Validate() const {
  LOWLAP_RETURN_IF_ERROR(EvidenceRegistry::BuiltIn().Make(features, without));
  if (!IsPositive(threshold_px)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the inlier threshold must be positive");
  }
  return {};
}

ScaleEstimator::ScaleEstimator(EvidenceKinds kinds)
    : kinds_(std::move(kinds)) {}

Result<ScaleRatio> ScaleEstimator::Estimate(const TripletView& triplet) const {
  LOWLAP_RETURN_IF_ERROR(CheckTriplet(triplet));
  return Estimate(triplet, GatherEvidence(kinds_, triplet));
}

Result<ScaleRatio> ScaleEstimator::Estimate(
    const TripletView& triplet, const TripletEvidence& evidence) const {
  LOWLAP_RETURN_IF_ERROR(CheckTriplet(triplet));
  return Judge(triplet, evidence);
}

std::unique_ptr<ScaleEstimator> MakeScaleEstimator(
    const ScaleOptions& options) {
  auto kinds =
      EvidenceRegistry::BuiltIn().Make(options.features, options.without);
  if (options.criterion == ScaleCriterion::kFixedThreshold) {
    return std::make_unique<FixedThresholdScaleEstimator>(
        std::move(*kinds), options.threshold_px, options.nfa_form,
        options.search);
  }
  return std::make_unique<AContrarioScaleEstimator>(
      std::move(*kinds), options.nfa_form, options.search);
}

}  // namespace lowlap
