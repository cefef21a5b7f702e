#include "lowlap/adjustment/internal/costs/intrinsic_freedom.h"

#include <algorithm>
#include <vector>

namespace lowlap {
namespace {

// Where it stands among the parameters of an intrinsic.
constexpr int kPrincipalPoint = 2;

}  // namespace

IntrinsicRefinement RefinementOf(const AdjustmentOptions& options,
                                 const IntrinsicState& intrinsic) {
  if (intrinsic.value.model == CameraModel::kSpherical) return {};
  IntrinsicRefinement refinement;
  const auto named = options.refine_intrinsics.find(intrinsic.id);
  if (named != options.refine_intrinsics.end()) refinement = named->second;
  refinement.principal_point |= options.principal_point_stddev > 0;
  return refinement;
}

double PrincipalPointStddevPx(const AdjustmentOptions& options,
                              const IntrinsicState& intrinsic) {
  if (intrinsic.value.model == CameraModel::kSpherical) return 0;
  return options.principal_point_stddev * intrinsic.value.ImageDiagonal();
}

Eigen::MatrixXd FreeDirections(const IntrinsicRefinement& refinement,
                               const IntrinsicState& intrinsic) {
  const int count = intrinsic.ParameterCount();
  std::vector<Eigen::VectorXd> directions;
  const auto add_axis = [&](int n) {
    directions.push_back(Eigen::VectorXd::Unit(count, n));
  };
  if (refinement.focal) {
    const Vec2 focals(intrinsic.parameters[0], intrinsic.parameters[1]);
    directions.push_back(Eigen::VectorXd::Zero(count));
    directions.back().head<2>() = focals.normalized();
  }
  if (refinement.aspect_ratio) add_axis(1);
  if (refinement.principal_point) {
    add_axis(kPrincipalPoint);
    add_axis(kPrincipalPoint + 1);
  }
  if (refinement.distortion) {
    for (int n = 4; n < count; ++n) add_axis(n);
  }
  Eigen::MatrixXd basis(count, directions.size());
  for (std::size_t n = 0; n < directions.size(); ++n) {
    basis.col(static_cast<int>(n)) = directions[n];
  }
  return basis;
}

PrincipalPointCost::PrincipalPointCost(const IntrinsicState& intrinsic,
                                       double stddev_px)
    : given_px_(intrinsic.given_principal_point_px), stddev_px_(stddev_px) {
  set_num_residuals(2);
  mutable_parameter_block_sizes()->push_back(intrinsic.ParameterCount());
}

bool PrincipalPointCost::Evaluate(double const* const* parameters,
                                  double* residuals, double** jacobians) const {
  const int count = parameter_block_sizes().front();
  for (int axis = 0; axis < 2; ++axis) {
    residuals[axis] =
        (parameters[0][kPrincipalPoint + axis] - given_px_(axis)) / stddev_px_;
  }
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    std::fill_n(jacobians[0], 2 * count, 0.0);
    for (int axis = 0; axis < 2; ++axis) {
      jacobians[0][axis * count + kPrincipalPoint + axis] = 1 / stddev_px_;
    }
  }
  return true;
}

}  // namespace lowlap
