#include "lowlap/adjustment/internal/center_covariance.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>

namespace lowlap::internal {
namespace {

using MatX = Eigen::MatrixXd;
using SparseMat = Eigen::SparseMatrix<double>;

MatX PseudoInverse(const MatX& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(matrix);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double floor = 1e-14 * std::max(0.0, values.maxCoeff());
  const Eigen::VectorXd inverse = values.unaryExpr(
      [&](double value) { return value > floor ? 1 / value : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() *
         eigen.eigenvectors().transpose();
}

// Columns of the Jacobian: the eliminated blocks first.
struct BlockColumns {
  std::vector<double*> blocks;
  std::vector<int> start;
  std::size_t eliminated_count = 0;
  int eliminated_size = 0;
};

BlockColumns OrderColumns(ProblemBuilder* builder) {
  const ceres::Problem& problem = builder->problem();
  const auto ordering = builder->Ordering();
  std::vector<double*> all;
  problem.GetParameterBlocks(&all);
  BlockColumns columns;
  int column = 0;
  for (const int group : {0, 1}) {
    for (double* block : all) {
      if (ordering->GroupId(block) != group ||
          problem.IsParameterBlockConstant(block)) {
        continue;
      }
      columns.blocks.push_back(block);
      columns.start.push_back(column);
      column += problem.ParameterBlockTangentSize(block);
    }
    if (group == 0) {
      columns.eliminated_count = columns.blocks.size();
      columns.eliminated_size = column;
    }
  }
  return columns;
}

// J^T J over these columns.
SparseMat Hessian(const BlockColumns& columns, ProblemBuilder* builder) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = columns.blocks;
  ceres::CRSMatrix crs;
  builder->problem().Evaluate(options, nullptr, nullptr, nullptr, &crs);
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
      crs.num_rows, crs.num_cols, static_cast<int>(crs.values.size()),
      crs.rows.data(), crs.cols.data(), crs.values.data());
  const SparseMat by_column = jacobian;
  return by_column.transpose() * by_column;
}

// The inverse of the eliminated blocks' own part, which is block diagonal.
SparseMat InverseOfEliminated(const SparseMat& hessian,
                              const BlockColumns& columns,
                              const ceres::Problem& problem) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t n = 0; n < columns.eliminated_count; ++n) {
    const int size = problem.ParameterBlockTangentSize(columns.blocks[n]);
    const int at = columns.start[n];
    const MatX inverse = PseudoInverse(MatX(hessian.block(at, at, size, size)));
    for (int row = 0; row < size; ++row) {
      for (int col = 0; col < size; ++col) {
        entries.emplace_back(at + row, at + col, inverse(row, col));
      }
    }
  }
  SparseMat result(columns.eliminated_size, columns.eliminated_size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// From the tangent space of the block to its three numbers.
MatX TangentToAmbient(const ceres::Problem& problem, double* block) {
  const ceres::Manifold* manifold = problem.GetManifold(block);
  if (manifold == nullptr) return Mat3::Identity();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      jacobian(3, manifold->TangentSize());
  manifold->PlusJacobian(block, jacobian.data());
  return jacobian;
}

}  // namespace

std::map<PoseId, Mat3> CenterCovariances(
    const std::vector<Component>& components,
    const std::vector<PoseState>& saved_references, const CameraSet& cameras,
    ProblemBuilder* builder) {
  const ceres::Problem& problem = builder->problem();
  const BlockColumns columns = OrderColumns(builder);
  const SparseMat hessian = Hessian(columns, builder);
  const int first = columns.eliminated_size;
  const int rest = static_cast<int>(hessian.cols()) - first;
  if (rest == 0) return {};
  const SparseMat cross = hessian.block(0, first, first, rest);
  const SparseMat explained = cross.transpose() *
                              InverseOfEliminated(hessian, columns, problem) *
                              cross;
  const MatX covariance = PseudoInverse(
      MatX(hessian.block(first, first, rest, rest)) - MatX(explained));

  std::map<const double*, int> start_of;
  for (std::size_t n = columns.eliminated_count; n < columns.blocks.size();
       ++n) {
    start_of[columns.blocks[n]] = columns.start[n] - first;
  }
  std::map<PoseId, Mat3> result;
  for (std::size_t n = 0; n < components.size(); ++n) {
    const Component& component = components[n];
    const double unit = component.baseline > 0 ? component.baseline : 1;
    const Mat3 world_from_frame =
        saved_references[n].cam_from_world.toRotationMatrix().transpose();
    for (const int pose : component.poses) {
      double* center = builder->CenterBlock(pose);
      const auto found = start_of.find(center);
      if (found == start_of.end()) continue;
      const int size = problem.ParameterBlockTangentSize(center);
      const MatX to_world =
          unit * world_from_frame * TangentToAmbient(problem, center);
      result[cameras.poses[pose].id] =
          to_world *
          covariance.block(found->second, found->second, size, size) *
          to_world.transpose();
    }
  }
  return result;
}

}  // namespace lowlap::internal
