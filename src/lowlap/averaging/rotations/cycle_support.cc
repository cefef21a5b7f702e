#include "lowlap/averaging/rotations/internal/cycle_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// In a dense graph every measurement has hundreds of triangles, and one without
// a triangle may have thousands of 4-cycles: some of them tell enough, and all
// would not fit into memory.
constexpr std::size_t kMaxTriangles = 100;
constexpr std::size_t kMaxQuads = 64;

struct Cycle {
  std::array<std::size_t, 4> edges = {};
  int length = 0;
  double closing_rad = 0;
};

struct Neighbor {
  std::size_t view = 0;
  std::size_t edge = 0;
};

class CycleFinder {
 public:
  CycleFinder(std::size_t num_views,
              const std::vector<RotationMeasurement>& measurements)
      : measurements_(measurements), neighbors_(num_views) {
    for (std::size_t e = 0; e < measurements.size(); ++e) {
      const RotationMeasurement& m = measurements[e];
      neighbors_[m.first].push_back({m.second, e});
      neighbors_[m.second].push_back({m.first, e});
    }
    for (std::vector<Neighbor>& list : neighbors_) {
      std::stable_sort(
          list.begin(), list.end(),
          [](const Neighbor& a, const Neighbor& b) { return a.view < b.view; });
    }
  }

  /// The cycles through every measurement.
  std::vector<std::vector<Cycle>> Find() const {
    std::vector<std::vector<Cycle>> through(measurements_.size());
    for (std::size_t e = 0; e < measurements_.size(); ++e) {
      FindSomeTriangles(e, &through[e]);
      if (through[e].empty()) FindQuads(e, &through[e]);
    }
    return through;
  }

 private:
  std::vector<std::size_t> Between(std::size_t a, std::size_t b) const {
    const std::vector<Neighbor>& list = neighbors_[a];
    auto it = std::lower_bound(
        list.begin(), list.end(), b,
        [](const Neighbor& n, std::size_t view) { return n.view < view; });
    std::vector<std::size_t> edges;
    for (; it != list.end() && it->view == b; ++it) edges.push_back(it->edge);
    return edges;
  }

  // Evenly among all, by apex.
  void FindSomeTriangles(std::size_t e, std::vector<Cycle>* cycles) const {
    const RotationMeasurement& m = measurements_[e];
    std::vector<std::pair<std::size_t, std::size_t>> others;
    const std::vector<Neighbor>& around_second = neighbors_[m.second];
    auto begin = around_second.begin();
    for (const Neighbor& to_first : neighbors_[m.first]) {
      const std::size_t apex = to_first.view;
      while (begin != around_second.end() && begin->view < apex) ++begin;
      for (auto it = begin; it != around_second.end() && it->view == apex;
           ++it) {
        others.emplace_back(it->edge, to_first.edge);
      }
    }
    const std::size_t count = std::min(others.size(), kMaxTriangles);
    for (std::size_t n = 0; n < count; ++n) {
      const auto& [f, g] = others[n * others.size() / count];
      cycles->push_back(Close({e, f, g, 0}, 3, m.first));
    }
  }

  void FindQuads(std::size_t e, std::vector<Cycle>* cycles) const {
    const RotationMeasurement& m = measurements_[e];
    for (const Neighbor& after : neighbors_[m.second]) {
      if (after.view == m.first) continue;
      for (const Neighbor& before : neighbors_[m.first]) {
        if (before.view == m.second || before.view == after.view) continue;
        for (const std::size_t f : Between(after.view, before.view)) {
          cycles->push_back(Close({e, after.edge, f, before.edge}, 4, m.first));
          if (cycles->size() >= kMaxQuads) return;
        }
      }
    }
  }

  // The angle left after going once round, from `view` over the edges.
  Cycle Close(const std::array<std::size_t, 4>& edges, int length,
              std::size_t view) const {
    Mat3 total = Mat3::Identity();
    for (int n = 0; n < length; ++n) {
      const RotationMeasurement& m = measurements_[edges[n]];
      if (m.first == view) {
        total = m.second_from_first * total;
        view = m.second;
      } else {
        total = m.second_from_first.transpose() * total;
        view = m.first;
      }
    }
    return {edges, length, RotationAngleBetween(Mat3::Identity(), total)};
  }

  const std::vector<RotationMeasurement>& measurements_;
  std::vector<std::vector<Neighbor>> neighbors_;
};

double LowerQuartile(const CycleSupport& support) {
  std::vector<double> errors;
  for (std::size_t e = 0; e < support.error_rad.size(); ++e) {
    if (support.num_cycles[e] > 0) errors.push_back(support.error_rad[e]);
  }
  if (errors.empty()) return 0;
  const auto quartile =
      errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 4);
  std::nth_element(errors.begin(), quartile, errors.end());
  return *quartile;
}

// One message: the closing errors of the cycles through e, each as far as its
// other members are trusted. `cycles` is not empty.
double WeightedClosing(std::size_t e, const std::vector<Cycle>& cycles,
                       const std::vector<double>& error_rad, double beta) {
  std::vector<double> others(cycles.size(), 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    for (int n = 0; n < cycles[c].length; ++n) {
      const std::size_t f = cycles[c].edges[n];
      if (f != e) others[c] += error_rad[f];
    }
    least = std::min(least, others[c]);
  }
  double sum = 0, total = 0;
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    const double weight = std::exp(-beta * (others[c] - least));
    sum += weight * cycles[c].closing_rad;
    total += weight;
  }
  return sum / total;
}

}  // namespace

CycleSupport ScoreCycles(std::size_t num_views,
                         const std::vector<RotationMeasurement>& measurements) {
  const std::vector<std::vector<Cycle>> through =
      CycleFinder(num_views, measurements).Find();
  CycleSupport support;
  support.error_rad.assign(measurements.size(), 0.0);
  for (const std::vector<Cycle>& cycles : through) {
    support.num_cycles.push_back(static_cast<int>(cycles.size()));
  }
  // beta = 0 takes the mean closing error.
  constexpr int kMaxSteps = 24;
  double beta = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    std::vector<double> next(measurements.size(), 0.0);
    for (std::size_t e = 0; e < measurements.size(); ++e) {
      if (through[e].empty()) continue;
      next[e] = WeightedClosing(e, through[e], support.error_rad, beta);
    }
    support.error_rad = std::move(next);
    support.typical_rad = LowerQuartile(support);
    if (beta * support.typical_rad > 1) break;
    beta = beta == 0 ? 1 : 2 * beta;
  }
  return support;
}

}  // namespace lowlap
