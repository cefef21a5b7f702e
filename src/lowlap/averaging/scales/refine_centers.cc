#include "lowlap/averaging/scales/internal/refine_centers.h"

#include <algorithm>
#include <array>
#include <cmath>

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
      : problem_(problem), row_(problem.views.size(), -1) {
    for (std::size_t n = 0; n < placed.size(); ++n) {
      if (placed[n]) row_[n] = num_rows_, num_rows_ += 3;
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
  }

  int num_rows() const { return num_rows_; }
  const std::vector<int>& row() const { return row_; }

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
  void Linearise(const std::vector<Vec3>& centers,
                 Eigen::SparseMatrix<double>* hessian,
                 Eigen::VectorXd* gradient) const {
    const std::vector<EdgeState> states = States(centers);
    std::vector<Eigen::Triplet<double>> entries;
    gradient->setZero(num_rows_);
    const auto add = [&](int a, int b, const Mat3& block) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          if (a + r >= b + c) entries.emplace_back(a + r, b + c, block(r, c));
        }
      }
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
      const int a = row_[edge.first], b = row_[edge.second];
      add(a, a, block);
      add(b, b, block);
      add(std::max(a, b), std::min(a, b), -block);
      gradient->segment<3>(a) -= pull;
      gradient->segment<3>(b) += pull;
    }
    for (const RatioMeasurement* ratio : ratios_) {
      const double error = RatioError(*ratio, states);
      const double weight = Weight(error * error);
      // d log L / dC_second = u / L, and the negative for C_first.
      const DirectionEdge& target = problem_.edges[ratio->target];
      const DirectionEdge& reference = problem_.edges[ratio->reference];
      const Vec3 gt = states[ratio->target].unit /
                      (states[ratio->target].length * Deviation(*ratio));
      const Vec3 gr = states[ratio->reference].unit /
                      (states[ratio->reference].length * Deviation(*ratio));
      const std::array<std::pair<int, Vec3>, 4> slopes = {{
          {row_[target.second], gt},
          {row_[target.first], -gt},
          {row_[reference.second], -gr},
          {row_[reference.first], gr},
      }};
      for (const auto& [a, slope_a] : slopes) {
        gradient->segment<3>(a) += weight * error * slope_a;
        for (const auto& [b, slope_b] : slopes) {
          if (a >= b) add(a, b, weight * slope_a * slope_b.transpose());
        }
      }
    }
    hessian->resize(num_rows_, num_rows_);
    hessian->setFromTriplets(entries.begin(), entries.end());
  }

 private:
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
  std::vector<int> row_;
  int num_rows_ = 0;
  std::vector<std::size_t> edges_;
  std::vector<const RatioMeasurement*> ratios_;
  double direction_scale_ = 1, ratio_scale_ = 1;
};

}  // namespace

Status RefineCenters(const TranslationProblem& problem,
                     const std::vector<bool>& placed, std::vector<Vec3>* result,
                     const RunContext& context, int max_iterations) {
  std::vector<Vec3> centers = *result;
  const Refiner refiner(problem, placed, centers);
  if (refiner.num_rows() == 0) return {};
  SparseSolver solver(context);
  double damping = 1e-4;
  double cost = refiner.Cost(centers);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    Eigen::SparseMatrix<double> hessian;
    Eigen::VectorXd gradient;
    refiner.Linearise(centers, &hessian, &gradient);
    bool improved = false;
    double relative_decrease = 0;
    // Damping also closes the gauge, which the Hessian leaves free.
    for (; damping < 1e8 && !improved; damping *= 10) {
      Eigen::SparseMatrix<double> damped = hessian;
      for (int r = 0; r < refiner.num_rows(); ++r) {
        damped.coeffRef(r, r) += damping * hessian.coeff(r, r);
      }
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, iteration, max_iterations));
      const auto step = solver.Solve(damped, -gradient);
      if (!step && step.error().code == ErrorCode::kCancelled) {
        return tl::unexpected<Error>(step.error());
      }
      if (!step) continue;
      std::vector<Vec3> trial = centers;
      for (std::size_t n = 0; n < trial.size(); ++n) {
        if (placed[n]) trial[n] += step->block<3, 1>(refiner.row()[n], 0);
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
    if (!improved || relative_decrease < 1e-6) break;
  }
  *result = std::move(centers);
  return {};
}

}  // namespace lowlap
