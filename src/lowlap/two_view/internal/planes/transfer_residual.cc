#include "lowlap/two_view/internal/planes/transfer_residual.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

TransferResidual::TransferResidual(const RigidTransform& cam2_from_cam1,
                                   const Vec3& plane_normal,
                                   const PointPairs& pairs)
    : pairs_(pairs), cam2_from_cam1_(cam2_from_cam1), normal_(plane_normal) {}

std::optional<TransferResidual::Transfer> TransferResidual::TransferOf(
    int pair) const {
  const Mat3& r = cam2_from_cam1_.rotation;
  const Vec3& t = cam2_from_cam1_.translation;
  const Vec3& x1 = pairs_.x1[pair];
  Transfer transfer;
  transfer.turned = r * x1;
  const Vec3 y = transfer.turned + t * normal_.dot(x1);
  if (!(y.z() > 0)) return std::nullopt;
  transfer.depth = y.z();
  transfer.place = y.head<2>() / y.z();
  transfer.error_px =
      pairs_.focal2_px * (pairs_.x2[pair].head<2>() - transfer.place);
  Mat2 warp;
  for (int k = 0; k < 2; ++k) {
    const Vec3 change = r.col(k) + t * normal_[k];
    warp.col(k) = (change.head<2>() - transfer.place * change.z()) / y.z();
  }
  warp *= pairs_.focal2_px / pairs_.focal1_px;
  transfer.covariance = pairs_.Covariance2(pair) +
                        warp * pairs_.Covariance1(pair) * warp.transpose();
  return transfer;
}

std::optional<Vec2> TransferResidual::operator()(int pair,
                                                 Jacobian* jacobian) const {
  const std::optional<Transfer> transfer = TransferOf(pair);
  if (!transfer) return std::nullopt;
  const Eigen::LLT<Mat2> root(transfer->covariance);
  if (root.info() != Eigen::Success) return std::nullopt;
  if (jacobian != nullptr) {
    const Vec3& x1 = pairs_.x1[pair];
    const Vec3& t = cam2_from_cam1_.translation;
    // -f2 dh = -f2 (dy_12 - h dy_3) / y_3 with y = H x1.
    Eigen::Matrix<double, 2, 3> by_y;
    by_y << Mat2::Identity(), -transfer->place;
    by_y *= -pairs_.focal2_px / transfer->depth;
    root.matrixL().solveInPlace(by_y);
    jacobian->leftCols<3>() = -by_y * CrossMatrix(transfer->turned);
    jacobian->middleCols<2>(3) = normal_.dot(x1) * by_y * TangentBasis(t);
    jacobian->rightCols<3>() = by_y * t * x1.transpose();
  }
  return Vec2(root.matrixL().solve(transfer->error_px));
}

double TransferResidual::Along(int pair, Vec3* by_normal) const {
  const std::optional<Transfer> transfer = TransferOf(pair);
  if (!transfer) return std::numeric_limits<double>::infinity();
  const Vec3& t = cam2_from_cam1_.translation;
  // The line runs where more inverse depth moves h.
  const Vec2 line_px = pairs_.focal2_px *
                       (t.head<2>() - transfer->place * t.z()) /
                       transfer->depth;
  const Vec2 direction = transfer->covariance.inverse() * line_px;
  const double norm = std::sqrt(line_px.dot(direction));
  if (!(norm > 0)) return std::numeric_limits<double>::infinity();
  if (by_normal != nullptr) *by_normal = -norm * pairs_.x1[pair];
  return direction.dot(transfer->error_px) / norm;
}

}  // namespace lowlap
