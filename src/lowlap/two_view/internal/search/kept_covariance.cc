#include "lowlap/two_view/internal/search/kept_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/two_view/internal/search/at_least.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {
namespace {

// With the axes of `from` turned to those of `to`, by the shortest way.
Mat5 Turned(const Mat5& covariance, const Vec3& from, const Vec3& to) {
  Mat5 turn = Mat5::Identity();
  turn.bottomRightCorner<2, 2>() =
      TangentBasis(to).transpose() *
      Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix() *
      TangentBasis(from);
  return turn * covariance * turn.transpose();
}

}  // namespace

std::optional<Mat5> KeptCovariance(const RelativePose& before,
                                   const RelativePose& after) {
  if (!before.covariance || after == before) return after.covariance;
  const Mat5 kept =
      Turned(*before.covariance, before.direction, after.direction);
  if (!after.covariance) return kept;
  const Eigen::LLT<Mat5> root(*after.covariance);
  // One without full rank has no such units; the sum is no less than either.
  if (root.info() != Eigen::Success) return Mat5(kept + *after.covariance);
  return AtLeast(root, kept, 1);
}

}  // namespace lowlap
