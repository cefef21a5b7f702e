#include "lowlap/averaging/rotations/internal/branch_turns.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "lowlap/averaging/internal/difference_solver.h"
#include "lowlap/averaging/rotations/internal/rotation_cost.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

constexpr int kMaxRounds = 10;
constexpr std::size_t kMaxAcross = 256;
constexpr std::size_t kMaxProposals = 16;
// Standard deviations up to which a measurement is met.
constexpr double kMeets = 5.0;

// The branches of a spanning forest: each view with all that lies beyond it.
class Branches {
 public:
  Branches(const std::vector<RotationMeasurement>& measurements,
           const std::vector<Mat3>& cam_from_world)
      : parent_(cam_from_world.size()),
        depth_(parent_.size(), 0),
        sizes_(parent_.size(), 1),
        places_(parent_.size(), 0),
        views_(parent_.size()),
        across_(parent_.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    std::vector<DifferenceEdge> edges;
    std::vector<double> costs;
    for (const RotationMeasurement& m : measurements) {
      edges.push_back({m.first, m.second});
      costs.push_back(RotationResidual(m, cam_from_world).norm() /
                      m.stddev_rad);
    }
    const std::vector<ForestStep> walk =
        MinimumSpanningForest(parent_.size(), edges, costs);
    for (const ForestStep& step : walk) {
      parent_[step.to] = step.from;
      depth_[step.to] = depth_[step.from] + 1;
    }
    for (auto step = walk.rbegin(); step != walk.rend(); ++step) {
      sizes_[step->from] += sizes_[step->to];
    }
    AssignPlaces(walk);
    for (std::size_t e = 0; e < edges.size(); ++e) AddToBranches(e, edges[e]);
  }

  // The measurements with one view in the branch; where there are more than
  // kMaxAcross, one more than that.
  const std::vector<std::size_t>& Across(std::size_t branch) const {
    return across_[branch];
  }
  bool Contains(std::size_t branch, std::size_t view) const {
    return places_[view] - places_[branch] < sizes_[branch];
  }
  void Turn(std::size_t branch, const Mat3& turn,
            std::vector<Mat3>* cam_from_world) const {
    const std::size_t begin = places_[branch];
    for (std::size_t p = begin; p < begin + sizes_[branch]; ++p) {
      Mat3& rotation = (*cam_from_world)[views_[p]];
      rotation = rotation * turn;
    }
  }

 private:
  // So that a branch is a range of places.
  void AssignPlaces(const std::vector<ForestStep>& walk) {
    std::vector<std::size_t> next(parent_.size());
    std::size_t begin = 0;
    for (std::size_t n = 0; n < parent_.size(); ++n) {
      if (parent_[n] != n) continue;
      places_[n] = begin;
      next[n] = begin + 1;
      begin += sizes_[n];
    }
    for (const ForestStep& step : walk) {
      places_[step.to] = next[step.from];
      next[step.to] = places_[step.to] + 1;
      next[step.from] += sizes_[step.to];
    }
    for (std::size_t n = 0; n < parent_.size(); ++n) views_[places_[n]] = n;
  }

  void AddToBranches(std::size_t e, DifferenceEdge way) {
    while (way.first != way.second) {
      if (depth_[way.first] < depth_[way.second]) {
        std::swap(way.first, way.second);
      }
      std::vector<std::size_t>& across = across_[way.first];
      if (across.size() <= kMaxAcross) across.push_back(e);
      way.first = parent_[way.first];
    }
  }

  std::vector<std::size_t> parent_, depth_;
  std::vector<std::size_t> sizes_;   // of the branch of a view, in views
  std::vector<std::size_t> places_;  // of a view
  std::vector<std::size_t> views_;   // by place
  std::vector<std::vector<std::size_t>> across_;
};

// The turn of the branch, to one of the measurements that lead to it, that
// lowers their costs most, if any does.
std::optional<Mat3> BestTurn(
    const std::vector<RotationMeasurement>& measurements,
    const std::vector<Mat3>& cam_from_world, const Branches& branches,
    std::size_t branch) {
  if (branches.Across(branch).size() > kMaxAcross) return std::nullopt;
  std::vector<std::pair<const RotationMeasurement*, Mat3>> turns;
  std::vector<Mat3> proposals;
  double met = 0, missed = 0, least = 0;
  for (const std::size_t e : branches.Across(branch)) {
    const RotationMeasurement& m = measurements[e];
    if (m.trusted) return std::nullopt;
    Mat3 turn = cam_from_world[m.second].transpose() * m.second_from_first *
                cam_from_world[m.first];
    if (!branches.Contains(branch, m.second)) turn.transposeInPlace();
    turns.emplace_back(&m, turn);
    const double angle_rad = AngleAxisFromRotation(turn).norm();
    least += CostOfAngle(m, angle_rad);
    if (angle_rad <= kMeets * m.stddev_rad) {
      met += EvidenceWeight(m);
    } else {
      missed += EvidenceWeight(m);
      proposals.push_back(turn);
    }
  }
  // A turn misses what is met, and cannot win more than what is missed.
  if (met >= missed) return std::nullopt;
  least -= 1e-6 * (1 + least);  // a turn that gains nothing could be undone
  std::optional<Mat3> best;
  const std::size_t count = std::min(proposals.size(), kMaxProposals);
  for (std::size_t n = 0; n < count; ++n) {
    const Mat3& proposal = proposals[n * proposals.size() / count];
    double cost = 0;
    for (const auto& [m, turn] : turns) {
      cost += CostOfAngle(*m, RotationAngleBetween(proposal, turn));
      if (cost >= least) break;
    }
    if (cost >= least) continue;
    least = cost;
    best = proposal;
  }
  return best;
}

}  // namespace

void TurnBranches(const std::vector<RotationMeasurement>& measurements,
                  std::vector<Mat3>* cam_from_world) {
  bool turned = true;
  for (int round = 0; turned && round < kMaxRounds; ++round) {
    turned = false;
    const Branches branches(measurements, *cam_from_world);
    for (std::size_t n = 0; n < cam_from_world->size(); ++n) {
      const std::optional<Mat3> turn =
          BestTurn(measurements, *cam_from_world, branches, n);
      if (!turn) continue;
      branches.Turn(n, *turn, cam_from_world);
      turned = true;
    }
  }
}

}  // namespace lowlap
