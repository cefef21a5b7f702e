#include "lowlap/averaging/rotations/internal/rotation_averaging.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/internal/difference_solver.h"
#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/averaging/rotations/internal/branch_turns.h"
#include "lowlap/averaging/rotations/internal/cycle_support.h"
#include "lowlap/averaging/rotations/internal/rotation_cost.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/robust/internal/robust_loss.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

std::vector<Mat3> ComposeAlongForest(
    std::size_t num_views, const std::vector<RotationMeasurement>& measurements,
    const std::vector<DifferenceEdge>& edges,
    const std::vector<double>& costs) {
  std::vector<Mat3> rotations(num_views, Mat3::Identity());
  for (const ForestStep& step :
       MinimumSpanningForest(num_views, edges, costs)) {
    const RotationMeasurement& m = measurements[step.edge];
    if (step.from == m.first) {
      rotations[m.second] = m.second_from_first * rotations[m.first];
    } else {
      rotations[m.first] =
          m.second_from_first.transpose() * rotations[m.second];
    }
  }
  return rotations;
}

std::vector<double> NormalisedResiduals(
    const std::vector<RotationMeasurement>& measurements,
    const std::vector<Mat3>& rotations) {
  std::vector<double> normalised;
  normalised.reserve(measurements.size());
  for (const RotationMeasurement& m : measurements) {
    normalised.push_back(RotationResidual(m, rotations).norm() / m.stddev_rad);
  }
  return normalised;
}

// Deviation per axis, from the given share of the residuals within `reach`: the
// lower quartile is moved by nothing that less than three in four of them do,
// the median is better where few are false.
enum class ScaleFrom { kQuartile, kMedian };
double ScaleWithin(const std::vector<double>& normalised, double reach,
                   ScaleFrom from) {
  std::vector<double> near;
  for (const double r : normalised) {
    if (r <= reach) near.push_back(r);
  }
  if (near.empty()) return 1;
  const bool quartile = from == ScaleFrom::kQuartile;
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(
                                         near.size() / (quartile ? 4 : 2));
  std::nth_element(near.begin(), middle, near.end());
  return std::max(
      1.0, *middle / (quartile ? kLowerQuartileOfNorm<3> : kMedianOfNorm<3>));
}

ViewPair ViewsOf(const RotationMeasurement& m) {
  return OrderedPair(static_cast<ViewId>(m.first),
                     static_cast<ViewId>(m.second));
}

// An order of measurements that depends on them alone.
bool IsBefore(const RotationMeasurement& a, const RotationMeasurement& b) {
  const auto key = [](const RotationMeasurement& m) {
    return std::make_tuple(ViewsOf(m), m.first, m.cost, m.stddev_rad,
                           m.trusted);
  };
  if (key(a) != key(b)) return key(a) < key(b);
  const Mat3 &p = a.second_from_first, &q = b.second_from_first;
  return std::lexicographical_compare(p.data(), p.data() + p.size(), q.data(),
                                      q.data() + q.size());
}

// The costs, each times a number in [0, 1) that is drawn for its views: other
// measurements do not change it. Those of the same views draw one by one.
std::vector<double> Shake(const std::vector<RotationMeasurement>& measurements,
                          std::uint64_t seed, std::size_t start,
                          std::vector<double> costs) {
  Random random(seed);
  for (std::size_t e = 0; e < costs.size(); ++e) {
    const ViewPair views = ViewsOf(measurements[e]);
    if (e == 0 || views != ViewsOf(measurements[e - 1])) {
      random = Random(PairSeed(seed, views), start);
    }
    costs[e] *= random.Uniform();
  }
  return costs;
}

/// Where a search begins. L1 finds one optimum from everywhere, and trusts the
/// stated deviations; without it the tree itself is tried.
struct Start {
  std::vector<double> costs;  // of the edges: the least spanning forest
  bool with_l1 = true;
};

std::vector<Start> MakeStarts(
    std::size_t num_views, const std::vector<RotationMeasurement>& measurements,
    const RotationAveragingOptions& options) {
  std::vector<double> own, cycles, joint;
  const CycleSupport support = ScoreCycles(num_views, measurements);
  for (std::size_t e = 0; e < measurements.size(); ++e) {
    // Without cycles an edge is as good as one of three times the usual error.
    const double x =
        support.num_cycles[e] == 0
            ? 1.0
            : support.error_rad[e] / std::max(3 * support.typical_rad, 1e-12);
    own.push_back(measurements[e].cost);
    cycles.push_back(x);
    joint.push_back(-EvidenceWeight(measurements[e]) / (1 + x * x));
  }
  std::vector<Start> starts = {
      {joint, true}, {joint, false}, {own, false}, {cycles, false}};
  // More starts pay off where they are cheap.
  constexpr std::size_t kBudget = 20000;
  const std::size_t affordable =
      std::max<std::size_t>(kBudget / (measurements.size() + 1), 2);
  const std::size_t count =
      std::min<std::size_t>(affordable, options.max_starts);
  for (std::size_t n = starts.size(); n < count; ++n) {
    starts.push_back({Shake(measurements, options.seed, n, joint), false});
  }
  if (starts.size() > count) starts.resize(count);
  return starts;
}

// Reweighted Gauss-Newton from the rotations in `result`.
Status Refine(const std::vector<RotationMeasurement>& measurements,
              const std::vector<DifferenceEdge>& edges,
              const RotationAveragingOptions& options, bool with_l1,
              const RunContext& context, RotationAveragingResult* result) {
  constexpr double kReach = 3.0;
  std::vector<Mat3>& rotations = result->cam_from_world;
  const Eigen::Index count = static_cast<Eigen::Index>(measurements.size());
  Eigen::VectorXd weights(count);
  Eigen::MatrixXd steps(count, 3);
  SparseSolver solver(context);
  // L1 has done its work long before half of the iterations.
  const int num_l1_iterations = options.max_iterations / 2;
  enum class Phase { kL1, kTighten, kPolish };
  Phase phase = with_l1 ? Phase::kL1 : Phase::kTighten;
  double scale = HUGE_VAL;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    LOWLAP_RETURN_IF_ERROR(
        AskToGoOn(context, iteration, options.max_iterations));
    std::vector<double> normalised(measurements.size());
    for (Eigen::Index e = 0; e < count; ++e) {
      steps.row(e) = RotationResidual(measurements[e], rotations);
      normalised[e] = steps.row(e).norm() / measurements[e].stddev_rad;
    }
    switch (phase) {
      case Phase::kL1:
        scale = ScaleWithin(normalised, HUGE_VAL, ScaleFrom::kQuartile);
        break;
      case Phase::kTighten:
        scale = std::min(
            scale, ScaleWithin(normalised, 5 * scale, ScaleFrom::kQuartile));
        break;
      case Phase::kPolish:
        scale = ScaleWithin(normalised, 5 * scale, ScaleFrom::kMedian);
        break;
    }
    for (Eigen::Index e = 0; e < count; ++e) {
      const double r = normalised[e] / scale;
      weights(e) = 1.0 / std::pow(measurements[e].stddev_rad, 2);
      if (measurements[e].trusted) continue;
      if (phase != Phase::kL1) {
        const double x = r / kReach;
        weights(e) *= GemanMcClureWeight(x * x);
      } else {
        weights(e) /= std::max(r, 0.1);
      }
    }
    // exp(-w_j) E exp(w_i) ~ log E + w_i - w_j, so w_j - w_i = log E.
    LOWLAP_ASSIGN_OR_RETURN(
        const auto tangent,
        SolveDifferences(rotations.size(), edges, weights, steps, &solver));
    double largest = 0;
    for (std::size_t n = 0; n < rotations.size(); ++n) {
      const Vec3 w = tangent.row(static_cast<Eigen::Index>(n));
      largest = std::max(largest, w.norm());
      rotations[n] = rotations[n] * RotationFromAngleAxis(w);
    }
    result->num_iterations = iteration + 1;
    if (phase == Phase::kPolish && largest < options.tolerance_rad) break;
    const bool settled = largest < 1e3 * options.tolerance_rad;
    if (phase == Phase::kTighten && settled) phase = Phase::kPolish;
    if (phase == Phase::kL1 &&
        (settled || iteration + 1 >= num_l1_iterations)) {
      phase = Phase::kTighten;
    }
  }
  result->deviation_scale =
      ScaleWithin(NormalisedResiduals(measurements, rotations), 5 * scale,
                  ScaleFrom::kMedian);
  return {};
}

}  // namespace

Status RotationAveragingOptions::Validate() const {
  if (max_iterations < 1 || max_starts < 1 || !(tolerance_rad > 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "rotation averaging: iterations, starts and tolerance "
                     "must be positive");
  }
  return {};
}

Result<RotationAveragingResult> AverageRotations(
    std::size_t num_views, const std::vector<RotationMeasurement>& measured,
    const RotationAveragingOptions& options, const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  for (const RotationMeasurement& m : measured) {
    if (m.first >= num_views || m.second >= num_views || m.first == m.second ||
        !(m.stddev_rad > 0)) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "rotation averaging: a measurement needs two different "
                       "views and a positive standard deviation");
    }
  }
  std::vector<RotationMeasurement> measurements = measured;
  std::sort(measurements.begin(), measurements.end(), IsBefore);
  std::vector<DifferenceEdge> edges;
  edges.reserve(measurements.size());
  for (const RotationMeasurement& m : measurements) {
    edges.push_back({m.first, m.second});
  }

  RotationAveragingResult best;
  best.cam_from_world.assign(num_views, Mat3::Identity());
  if (measurements.empty()) return best;
  double best_cost = HUGE_VAL;
  for (const Start& start : MakeStarts(num_views, measurements, options)) {
    RotationAveragingResult result;
    result.cam_from_world =
        ComposeAlongForest(num_views, measurements, edges, start.costs);
    if (!start.with_l1) TurnBranches(measurements, &result.cam_from_world);
    LOWLAP_RETURN_IF_ERROR(
        Refine(measurements, edges, options, start.with_l1, context, &result));
    const double cost = RobustCost(measurements, result.cam_from_world);
    // A start that ends in the same place does not replace an earlier one.
    if (cost < best_cost - 1e-6 * (1 + std::abs(cost))) {
      best_cost = cost;
      best = std::move(result);
    }
  }
  for (const RotationMeasurement& m : measured) {
    best.residuals_rad.push_back(
        RotationResidual(m, best.cam_from_world).norm());
  }
  return best;
}

}  // namespace lowlap
