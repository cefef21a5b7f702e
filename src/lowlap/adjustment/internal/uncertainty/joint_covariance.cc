#include "lowlap/adjustment/internal/uncertainty/joint_covariance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using Motions = Eigen::Matrix<double, Eigen::Dynamic, 7>;

// How a similarity moves the centres: about their mean, in units of their
// extent.
Motions MotionsBySimilarity(const std::vector<Vec3>& centers) {
  const auto count = static_cast<Eigen::Index>(centers.size());
  Vec3 mean = Vec3::Zero();
  for (const Vec3& center : centers) mean += center / count;
  double size = 0;
  for (const Vec3& center : centers) {
    size = std::max(size, (center - mean).norm());
  }
  Motions motions(3 * count, 7);
  for (Eigen::Index n = 0; n < count; ++n) {
    const Vec3 arm = size > 0 ? Vec3((centers[n] - mean) / size) : Vec3::Zero();
    motions.middleRows<3>(3 * n) << Mat3::Identity(), CrossMatrix(arm), arm;
  }
  return motions;
}

// F = (G^T W G)^-1 G^T W: the similarity that follows the centres. A turn about
// the line on which all centres lie does not move them.
Eigen::MatrixXd SimilarityFromCenters(const Motions& motions,
                                      const Eigen::VectorXd& weights) {
  using Mat7 = Eigen::Matrix<double, 7, 7>;
  using Vec7 = Eigen::Matrix<double, 7, 1>;
  const Motions weighted = weights.asDiagonal() * motions;
  const Eigen::SelfAdjointEigenSolver<Mat7> eigen(motions.transpose() *
                                                  weighted);
  const double floor = 1e-12 * eigen.eigenvalues().maxCoeff();
  const Vec7 inverse = (eigen.eigenvalues().array() > floor)
                           .select(eigen.eigenvalues().cwiseInverse(), 0.0);
  return eigen.eigenvectors() * inverse.asDiagonal() *
         eigen.eigenvectors().transpose() * weighted.transpose();
}

std::vector<Mat3> WithoutSimilarity(const JointCovariance& joint,
                                    const BlockMap& blocks,
                                    const Motions& motions,
                                    const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd follow = SimilarityFromCenters(motions, weights);
  const Eigen::MatrixXd crossed = joint.Times(follow.transpose());  // C F^T
  const Eigen::MatrixXd inner = follow * crossed;
  std::vector<Mat3> free;
  for (Eigen::Index n = 0; 3 * n < motions.rows(); ++n) {
    const Eigen::Matrix<double, 3, 7> own = motions.middleRows<3>(3 * n);
    const Mat3 shared = crossed.middleRows<3>(3 * n) * own.transpose();
    free.emplace_back(blocks.at({n, n}) - shared - shared.transpose() +
                      own * inner * own.transpose());
  }
  return free;
}

}  // namespace

Eigen::MatrixXd JointCovariance::Times(const Eigen::MatrixXd& right) const {
  const Eigen::MatrixXd kept = centers_from_kept_.transpose() * right;
  Eigen::MatrixXd solved = factor_.solve(kept);
  if (scatter_ != nullptr) {
    const Eigen::MatrixXd scattered = *scatter_ * solved;
    solved = factor_.solve(scattered);
  }
  return centers_from_kept_ * solved;
}

BlockMap JointCovariance::Blocks(const std::set<PlacePair>& pairs) const {
  BlockMap blocks;
  const Eigen::Index count = centers_from_kept_.rows() / 3;
  for (Eigen::Index n = 0; n < count; ++n) {
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(3 * count, 3);
    unit.middleRows<3>(3 * n).setIdentity();
    const Eigen::MatrixXd column = Times(unit);
    blocks[{n, n}] = column.middleRows<3>(3 * n);
    for (auto pair = pairs.lower_bound({n, n});
         pair != pairs.end() && pair->first == n; ++pair) {
      blocks[*pair] = column.middleRows<3>(3 * pair->second).transpose();
    }
  }
  return blocks;
}

std::vector<Mat3> CovariancesWithoutGauge(const JointCovariance& joint,
                                          const BlockMap& blocks,
                                          const std::vector<Vec3>& centers) {
  const Motions motions = MotionsBySimilarity(centers);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(motions.rows());
  std::vector<Mat3> free;
  constexpr int kMaxIterations = 100;
  constexpr double kSettled = 1e-3;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    free = WithoutSimilarity(joint, blocks, motions, weights);
    std::vector<double> variances;
    variances.reserve(free.size());
    for (const Mat3& block : free) variances.push_back(block.trace());
    const double typical = Median(variances);
    if (!(typical > 0)) break;
    Eigen::VectorXd next = weights;
    for (std::size_t n = 0; n < free.size(); ++n) {
      next.segment<3>(3 * static_cast<Eigen::Index>(n))
          .setConstant(typical / (typical + variances[n]));
    }
    const double change =
        ((next - weights).array() / next.array()).abs().maxCoeff();
    weights = std::move(next);
    if (change < kSettled) break;
  }
  return free;
}

}  // namespace lowlap
