#include "lowlap/averaging/scales/internal/refine_centers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lowlap/averaging/internal/block_matrix.h"
#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/robust/internal/robust_loss.h"

namespace lowlap {
namespace {

struct EdgeState {
  double length = 0;
  Vec3 unit = Vec3::Zero();
};

// Of the loss, in deviations.
constexpr double kReachSquared = 9.0;

double Loss(double squared) {
  return kReachSquared * GemanMcClureLoss(squared / kReachSquared);
}

double Weight(double squared) {
  return GemanMcClureWeight(squared / kReachSquared);
}

class Refiner {
 public:
  Refiner(const TranslationProblem& problem, const std::vector<bool>& placed,
          const std::vector<Vec3>& start)
      : problem_(problem), block_of_view_(problem.views.size(), 0) {
    for (std::size_t n = 0; n < placed.size(); ++n) {
      if (placed[n]) block_of_view_[n] = num_blocks_++;
    }
    const auto both_placed = [&](std::size_t e) {
      return placed[problem.edges[e].first] && placed[problem.edges[e].second];
    };
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
      if (both_placed(e)) edges_.push_back(e);
    }
    for (const RatioMeasurement& ratio : problem.ratios) {
      if (both_placed(ratio.reference) && both_placed(ratio.target)) {
        ratios_.push_back(&ratio);
      }
    }
    SetDeviations(start);
    hessian_ = BlockMatrix(num_blocks_, PlacesInOrder());
    for (const BlockMatrix::Place& place : PlacesInOrder()) {
      blocks_.push_back(hessian_.FindBlock(place.first, place.second));
    }
  }

  std::size_t num_blocks() const { return num_blocks_; }
  /// Where a placed view's three unknowns begin.
  Eigen::Index RowOf(std::size_t view) const {
    return static_cast<Eigen::Index>(3 * block_of_view_[view]);
  }
  /// What Linearise has found.
  const Eigen::SparseMatrix<double>& hessian() const {
    return hessian_.lower();
  }
  const Eigen::VectorXd& gradient() const { return gradient_; }

  /// The robust cost; infinite if two joined views coincide.
  double Cost(const std::vector<Vec3>& centers) const {
    const std::vector<EdgeState> states = States(centers);
    double cost = 0;
    for (const std::size_t e : edges_) {
      if (!(states[e].length > 0)) return HUGE_VAL;
      cost += Loss(DirectionError(e, states[e]).squaredNorm());
    }
    for (const RatioMeasurement* ratio : ratios_) {
      cost += Loss(std::pow(RatioError(*ratio, states), 2));
    }
    return cost;
  }

  /// Gauss-Newton system of the reweighted residuals.
  void Linearise(const std::vector<Vec3>& centers) {
    const std::vector<EdgeState> states = States(centers);
    hessian_.SetZero();
    gradient_.setZero(static_cast<Eigen::Index>(3 * num_blocks_));
    auto block_number = blocks_.begin();
    const auto add = [&](const Mat3& block) {
      hessian_.Add(*block_number++, block);
    };
    for (const std::size_t e : edges_) {
      const EdgeState& s = states[e];
      const DirectionEdge& edge = problem_.edges[e];
      const Vec3 error = DirectionError(e, s);
      const double weight = Weight(error.squaredNorm());
      const Mat3 jacobian = (Mat3::Identity() - s.unit * s.unit.transpose()) /
                            (s.length * Deviation(edge));
      const Mat3 block = weight * jacobian.transpose() * jacobian;
      const Vec3 pull = weight * jacobian.transpose() * error;
      add(block);
      add(block);
      add(-block);
      gradient_.segment<3>(RowOf(edge.first)) -= pull;
      gradient_.segment<3>(RowOf(edge.second)) += pull;
    }
    for (const RatioMeasurement* ratio : ratios_) {
      const double error = RatioError(*ratio, states);
      const double weight = Weight(error * error);
      // d log L / dC_second = u / L, and the negative for C_first.
      const Vec3 gt = states[ratio->target].unit /
                      (states[ratio->target].length * Deviation(*ratio));
      const Vec3 gr = states[ratio->reference].unit /
                      (states[ratio->reference].length * Deviation(*ratio));
      const std::array<std::size_t, 4> views = ViewsOf(*ratio);
      const std::array<Vec3, 4> slopes = {gt, -gt, -gr, gr};
      for (int a = 0; a < 4; ++a) {
        gradient_.segment<3>(RowOf(views[a])) += weight * error * slopes[a];
        for (int b = 0; b < 4; ++b) {
          if (RowOf(views[a]) < RowOf(views[b])) continue;
          add(weight * slopes[a] * slopes[b].transpose());
        }
      }
    }
  }

 private:
  /// The ends of the target, then those of the reference.
  std::array<std::size_t, 4> ViewsOf(const RatioMeasurement& ratio) const {
    const DirectionEdge& target = problem_.edges[ratio.target];
    const DirectionEdge& reference = problem_.edges[ratio.reference];
    return {target.second, target.first, reference.second, reference.first};
  }

  /// The blocks that Linearise adds to, in its order.
  std::vector<BlockMatrix::Place> PlacesInOrder() const {
    std::vector<BlockMatrix::Place> places;
    for (const std::size_t e : edges_) {
      const std::size_t a = block_of_view_[problem_.edges[e].first];
      const std::size_t b = block_of_view_[problem_.edges[e].second];
      places.emplace_back(a, a);
      places.emplace_back(b, b);
      places.emplace_back(std::max(a, b), std::min(a, b));
    }
    for (const RatioMeasurement* ratio : ratios_) {
      for (const std::size_t view_a : ViewsOf(*ratio)) {
        for (const std::size_t view_b : ViewsOf(*ratio)) {
          const std::size_t a = block_of_view_[view_a];
          const std::size_t b = block_of_view_[view_b];
          if (a >= b) places.emplace_back(a, b);
        }
      }
    }
    return places;
  }

  void SetDeviations(const std::vector<Vec3>& start) {
    const std::vector<EdgeState> states = States(start);
    std::vector<double> directions, ratios;
    for (const std::size_t e : edges_) {
      directions.push_back(DirectionError(e, states[e]).norm());
    }
    for (const RatioMeasurement* ratio : ratios_) {
      ratios.push_back(std::abs(RatioError(*ratio, states)));
    }
    direction_scale_ =
        std::max(1.0, Median(std::move(directions)) / kMedianOfNorm<2>);
    ratio_scale_ = std::max(1.0, Median(std::move(ratios)) / kMedianOfNorm<1>);
  }

  double Deviation(const DirectionEdge& edge) const {
    return direction_scale_ * edge.stddev_rad;
  }
  double Deviation(const RatioMeasurement& ratio) const {
    return ratio_scale_ * ratio.stddev;
  }

  std::vector<EdgeState> States(const std::vector<Vec3>& centers) const {
    std::vector<EdgeState> states(problem_.edges.size());
    for (const std::size_t e : edges_) {
      const Vec3 difference =
          centers[problem_.edges[e].second] - centers[problem_.edges[e].first];
      states[e].length = difference.norm();
      if (states[e].length > 0) states[e].unit = difference / states[e].length;
    }
    return states;
  }

  Vec3 DirectionError(std::size_t e, const EdgeState& state) const {
    return (state.unit - problem_.edges[e].direction_in_world) /
           Deviation(problem_.edges[e]);
  }

  double RatioError(const RatioMeasurement& ratio,
                    const std::vector<EdgeState>& states) const {
    return (std::log(states[ratio.target].length) -
            std::log(states[ratio.reference].length) - ratio.log_ratio) /
           Deviation(ratio);
  }

  const TranslationProblem& problem_;
  std::vector<std::size_t> block_of_view_;
  std::size_t num_blocks_ = 0;
  std::vector<std::size_t> edges_;
  std::vector<const RatioMeasurement*> ratios_;
  double direction_scale_ = 1, ratio_scale_ = 1;
  BlockMatrix hessian_{0, {}};
  std::vector<std::size_t> blocks_;  // of PlacesInOrder
  Eigen::VectorXd gradient_;
};

}  // namespace

Status RefineCenters(const TranslationProblem& problem,
                     const std::vector<bool>& placed, std::vector<Vec3>* result,
                     const RunContext& context, int max_iterations) {
  std::vector<Vec3> centers = *result;
  Refiner refiner(problem, placed, centers);
  if (refiner.num_blocks() == 0) return {};
  SparseSolver solver(context);
  // Per direction, in variances: rounding is left, which goes on falling.
  constexpr double kNoCost = 1e-20;
  double damping = 1e-4;
  double cost = refiner.Cost(centers);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    refiner.Linearise(centers);
    bool improved = false;
    double relative_decrease = 0;
    // Damping also closes the gauge, which the Hessian leaves free.
    for (; damping < 1e8 && !improved; damping *= 10) {
      Eigen::SparseMatrix<double> damped = refiner.hessian();
      for (Eigen::Index r = 0; r < damped.rows(); ++r) {
        damped.coeffRef(r, r) += damping * refiner.hessian().coeff(r, r);
      }
      const Status go_on = AskToGoOn(context, iteration, max_iterations);
      if (!go_on) return go_on;
      const auto step = solver.Solve(damped, -refiner.gradient());
      if (!step && step.error().code == ErrorCode::kCancelled) {
        return tl::unexpected<Error>(step.error());
      }
      if (!step) continue;
      // A solution takes its time, and so do the sums that follow.
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, iteration, max_iterations));
      std::vector<Vec3> trial = centers;
      for (std::size_t n = 0; n < trial.size(); ++n) {
        if (placed[n]) trial[n] += step->block<3, 1>(refiner.RowOf(n), 0);
      }
      const double trial_cost = refiner.Cost(trial);
      if (trial_cost < cost) {
        relative_decrease = (cost - trial_cost) / cost;
        cost = trial_cost;
        centers = std::move(trial);
        improved = true;
        damping = std::max(damping / 100, 1e-8);
      }
    }
    if (!improved || relative_decrease < 1e-6 ||
        cost <= kNoCost * static_cast<double>(problem.edges.size())) {
      break;
    }
  }
  *result = std::move(centers);
  return {};
}

}  // namespace lowlap
