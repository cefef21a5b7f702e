#include "lowlap/adjustment/internal/structure/point_shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "lowlap/adjustment/internal/structure/point_track.h"

namespace lowlap {
namespace {

constexpr std::size_t kMinPoses = 3;
// Of ln r^2 for a Gaussian error r: pi^2 / 2.
constexpr double kLogSquareVariance = 4.93;
// What is believed before any error is seen.
constexpr double kPriorMean = 0.5;
constexpr double kPriorVariance = 0.25;
constexpr double kLeastErrorPx = 1e-3;

}  // namespace

PointShape PointShape::FromCovariance(const Vec3& covariance) {
  const Mat2 matrix =
      (Mat2() << covariance(0), covariance(1), covariance(1), covariance(2))
          .finished();
  const Eigen::SelfAdjointEigenSolver<Mat2> solver(matrix);
  PointShape shape;
  shape.weak_direction = solver.eigenvectors().col(1);
  // A valid covariance may be singular but for rounding.
  constexpr double kLeastShare = 1e-6;
  const double weak = solver.eigenvalues()(1);
  const double strong = std::max(solver.eigenvalues()(0), kLeastShare * weak);
  shape.log_variance_ratio = std::log(weak / strong);
  return shape;
}

Mat2 PointShape::Whitening(double exponent) const {
  const double weak = std::exp(-0.5 * exponent * log_variance_ratio);
  return Mat2::Identity() -
         (1 - weak) * weak_direction * weak_direction.transpose();
}

double EstimateShapeExponent(const CameraSet& cameras,
                             const std::vector<PointTrackState>& points) {
  double count = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const PointTrackState& track : points) {
    if (!track.IsLandmark() || track.PoseCount(cameras) < kMinPoses) continue;
    for (const PointCandidate& candidate : track.candidates) {
      if (!candidate.used) continue;
      const std::optional<Vec2> error =
          PointDifferencePx(cameras, candidate, track.position);
      if (!error) continue;
      const double x = candidate.shape.log_variance_ratio;
      const double along = std::max(
          kLeastErrorPx, std::abs(candidate.shape.weak_direction.dot(*error)));
      const double y = 2 * std::log(along);
      count += 1;
      sum_x += x;
      sum_y += y;
      sum_xx += x * x;
      sum_xy += x * y;
    }
  }
  const double spread = count > 0 ? sum_xx - sum_x * sum_x / count : 0;
  const double product = count > 0 ? sum_xy - sum_x * sum_y / count : 0;
  const double information = spread / kLogSquareVariance;
  return std::clamp(
      (product / kLogSquareVariance + kPriorMean / kPriorVariance) /
          (information + 1 / kPriorVariance),
      0.0, 1.0);
}

void WhitenPoints(double exponent, std::vector<PointTrackState>* points) {
  for (PointTrackState& track : *points) {
    for (PointCandidate& candidate : track.candidates) {
      candidate.whitening = candidate.shape.Whitening(exponent);
    }
  }
}

}  // namespace lowlap
