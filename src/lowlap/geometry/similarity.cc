#include "lowlap/geometry/similarity.h"

#include <Eigen/SVD>

namespace lowlap {

Similarity Similarity::Inverse() const {
  Similarity inverse;
  inverse.scale = 1.0 / scale;
  inverse.rotation = rotation.transpose();
  inverse.translation = -inverse.scale * (inverse.rotation * translation);
  return inverse;
}

Result<Similarity> AlignPoints(const std::vector<Vec3>& source,
                               const std::vector<Vec3>& target) {
  if (source.size() != target.size()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "alignment needs as many sources as targets");
  }
  if (source.size() < 2) {
    return MakeError(ErrorCode::kInsufficientData,
                     "alignment needs at least 2 points");
  }
  const double weight = 1.0 / static_cast<double>(source.size());
  Vec3 source_mean = Vec3::Zero(), target_mean = Vec3::Zero();
  for (std::size_t n = 0; n < source.size(); ++n) {
    source_mean += weight * source[n];
    target_mean += weight * target[n];
  }
  double source_variance = 0, target_variance = 0;
  Mat3 covariance = Mat3::Zero();
  for (std::size_t n = 0; n < source.size(); ++n) {
    const Vec3 s = source[n] - source_mean;
    const Vec3 t = target[n] - target_mean;
    source_variance += weight * s.squaredNorm();
    target_variance += weight * t.squaredNorm();
    covariance += weight * t * s.transpose();
  }
  if (source_variance <= 1e-24 * (1.0 + source_mean.squaredNorm()) ||
      target_variance <= 1e-24 * (1.0 + target_mean.squaredNorm())) {
    return MakeError(ErrorCode::kInsufficientData,
                     "alignment needs points that do not coincide");
  }
  const Eigen::JacobiSVD<Mat3> svd(covariance,
                                   Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& singular = svd.singularValues();
  Similarity result;
  Vec3 signs(1, 1, 1);
  if (singular.y() <= 1e-12 * singular.x()) {
    // One line on both sides: rotate it onto the other the short way.
    result.rotation = Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0),
                                                         svd.matrixU().col(0))
                          .toRotationMatrix();
  } else {
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) {
      signs.z() = -1;
    }
    result.rotation =
        svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  }
  result.scale = singular.dot(signs) / source_variance;
  result.translation =
      target_mean - result.scale * (result.rotation * source_mean);
  return result;
}

}  // namespace lowlap
