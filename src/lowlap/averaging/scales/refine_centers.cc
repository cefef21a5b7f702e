#include "lowlap/averaging/scales/internal/refine_centers.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lowlap/averaging/internal/minimise.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/robust/internal/robust_loss.h"

namespace lowlap {
namespace {

template <class T>
using Vec3Of = Eigen::Matrix<T, 3, 1>;

template <class T>
Vec3Of<T> Difference(const T* from, const T* to) {
  return Eigen::Map<const Vec3Of<T>>(to) - Eigen::Map<const Vec3Of<T>>(from);
}

// Undefined where two joined views coincide.
struct DirectionError {
  Vec3 direction_in_world;
  double stddev;

  template <class T>
  bool operator()(const T* first, const T* second, T* error) const {
    const Vec3Of<T> offset = Difference(first, second);
    const T length = offset.norm();
    Eigen::Map<Vec3Of<T>> mapped(error);
    mapped = (offset / length - direction_in_world) / T(stddev);
    return length > 0.0;
  }
};

// Lengths from the view that the two edges share.
struct RatioError {
  double log_ratio;
  double stddev;

  template <class T>
  bool operator()(const T* shared, const T* reference, const T* target,
                  T* error) const {
    const T to_reference = Difference(shared, reference).norm();
    const T to_target = Difference(shared, target).norm();
    *error = (log(to_target / to_reference) - log_ratio) / stddev;
    return to_target > 0.0 && to_reference > 0.0;
  }
};

// Of the loss, in deviations.
constexpr double kReachSquared = 9.0;

class GemanMcClure final : public ceres::LossFunction {
 public:
  void Evaluate(double squared, double rho[3]) const override {
    const double x = squared / kReachSquared;
    rho[0] = kReachSquared * GemanMcClureLoss(x);
    rho[1] = GemanMcClureWeight(x);
    rho[2] = -2 * rho[1] / ((1 + x) * kReachSquared);
  }
};

// At least 1.
double MedianFactor(std::vector<double> errors, double median_of_unit) {
  return std::max(1.0, Median(std::move(errors)) / median_of_unit);
}

}  // namespace

Status RefineCenters(const TranslationProblem& problem,
                     const std::vector<bool>& placed, std::vector<Vec3>* result,
                     const RunContext& context, int max_iterations) {
  std::vector<Vec3> centers = *result;
  std::vector<DirectionError> directions;
  std::vector<std::array<double*, 2>> direction_blocks;
  std::vector<double> direction_sizes, ratio_sizes;
  for (const DirectionEdge& edge : problem.edges) {
    if (!placed[edge.first] || !placed[edge.second]) continue;
    directions.push_back({edge.direction_in_world, edge.stddev_rad});
    direction_blocks.push_back(
        {centers[edge.first].data(), centers[edge.second].data()});
    Vec3 error = Vec3::Zero();
    // Joined views that coincide have no direction, and leave no way to go.
    if (!directions.back()(direction_blocks.back()[0],
                           direction_blocks.back()[1], error.data())) {
      return {};
    }
    direction_sizes.push_back(error.norm());
  }
  std::vector<RatioError> ratios;
  std::vector<std::array<double*, 3>> ratio_blocks;
  for (const RatioMeasurement& ratio : problem.ratios) {
    const DirectionEdge& reference = problem.edges[ratio.reference];
    const DirectionEdge& target = problem.edges[ratio.target];
    const bool shares_first =
        reference.first == target.first || reference.first == target.second;
    const std::size_t shared =
        shares_first ? reference.first : reference.second;
    if (target.first != shared && target.second != shared) continue;
    const std::size_t from = reference.first + reference.second - shared;
    const std::size_t to = target.first + target.second - shared;
    if (from == to || !placed[shared] || !placed[from] || !placed[to]) continue;
    ratios.push_back({ratio.log_ratio, ratio.stddev});
    ratio_blocks.push_back(
        {centers[shared].data(), centers[from].data(), centers[to].data()});
    double error = 0;
    if (!ratios.back()(ratio_blocks.back()[0], ratio_blocks.back()[1],
                       ratio_blocks.back()[2], &error)) {
      return {};
    }
    ratio_sizes.push_back(std::abs(error));
  }
  if (directions.empty()) return {};
  const double direction_factor =
      MedianFactor(std::move(direction_sizes), kMedianOfNorm<2>);
  const double ratio_factor =
      MedianFactor(std::move(ratio_sizes), kMedianOfNorm<1>);

  GemanMcClure loss;
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem least_squares(problem_options);
  for (std::size_t n = 0; n < directions.size(); ++n) {
    directions[n].stddev *= direction_factor;
    least_squares.AddResidualBlock(
        new ceres::AutoDiffCostFunction<DirectionError, 3, 3, 3>(
            new DirectionError(directions[n])),
        &loss, direction_blocks[n][0], direction_blocks[n][1]);
  }
  for (std::size_t n = 0; n < ratios.size(); ++n) {
    ratios[n].stddev *= ratio_factor;
    least_squares.AddResidualBlock(
        new ceres::AutoDiffCostFunction<RatioError, 1, 3, 3, 3>(
            new RatioError(ratios[n])),
        &loss, ratio_blocks[n][0], ratio_blocks[n][1], ratio_blocks[n][2]);
  }
  const auto iterations =
      Minimise(context, max_iterations, 1e-6, &least_squares);
  if (!iterations) return tl::unexpected<Error>(iterations.error());
  *result = std::move(centers);
  return {};
}

}  // namespace lowlap
