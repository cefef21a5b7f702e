#include "lowlap/averaging/strategies/internal/triplet_baselines.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/core/internal/union_find.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using EdgePair = std::pair<std::size_t, std::size_t>;

// A triangle walked around: sum of sign[n] length[n] direction[n] = 0.
struct Triangle {
  std::array<std::size_t, 3> edges;
  std::array<double, 3> signs;
};

std::vector<Triangle> FindTriangles(const TranslationProblem& problem) {
  std::vector<std::map<std::size_t, std::size_t>> neighbors(
      problem.views.size());  // view -> edge
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const DirectionEdge& edge = problem.edges[e];
    neighbors[edge.first].emplace(edge.second, e);
    neighbors[edge.second].emplace(edge.first, e);
  }
  std::vector<Triangle> triangles;
  const auto sign = [&](std::size_t e, std::size_t from) {
    return problem.edges[e].first == from ? 1.0 : -1.0;
  };
  for (std::size_t a = 0; a < neighbors.size(); ++a) {
    for (const auto& [b, ab] : neighbors[a]) {
      if (b < a) continue;
      for (const auto& [c, bc] : neighbors[b]) {
        if (c < b) continue;
        const auto ca = neighbors[c].find(a);
        if (ca == neighbors[c].end()) continue;
        triangles.push_back({{ab, bc, ca->second},
                             {sign(ab, a), sign(bc, b), sign(ca->second, c)}});
      }
    }
  }
  return triangles;
}

// The most meaningful ratio of every two edges, target over the smaller index.
std::map<EdgePair, RatioMeasurement> BestRatios(
    const TranslationProblem& problem) {
  std::map<EdgePair, RatioMeasurement> best;
  for (RatioMeasurement ratio : problem.ratios) {
    if (ratio.reference > ratio.target) {
      std::swap(ratio.reference, ratio.target);
      ratio.log_ratio = -ratio.log_ratio;
    }
    const auto [entry, is_new] =
        best.emplace(EdgePair{ratio.reference, ratio.target}, ratio);
    if (!is_new && ratio.log10_nfa < entry->second.log10_nfa) {
      entry->second = ratio;
    }
  }
  return best;
}

double SmallestAngleRad(const std::array<Vec3, 3>& walked) {
  double smallest = kPi;
  for (int n = 0; n < 3; ++n) {
    // The inner angle between a side and the next.
    const double turn = AngleBetween(walked[n], walked[(n + 1) % 3]);
    smallest = std::min({smallest, turn, kPi - turn});
  }
  return smallest;
}

// Baselines, walked around; closure_rad is set. nullopt: too flat, or a length
// that is not positive.
std::optional<std::array<Vec3, 3>> Baselines(
    const TranslationProblem& problem, const Triangle& triangle,
    const std::map<EdgePair, RatioMeasurement>& ratios,
    const TripletProgramOptions& options, TripletMotion* motion) {
  std::array<Vec3, 3> walked;
  for (int n = 0; n < 3; ++n) {
    walked[n] =
        triangle.signs[n] * problem.edges[triangle.edges[n]].direction_in_world;
  }
  const RatioMeasurement* best = nullptr;
  int closing = 0;
  for (int n = 0; n < 3; ++n) {
    const auto [low, high] =
        std::minmax(triangle.edges[(n + 1) % 3], triangle.edges[(n + 2) % 3]);
    const auto found = ratios.find({low, high});
    if (found == ratios.end()) continue;
    if (best == nullptr || found->second.log10_nfa < best->log10_nfa) {
      best = &found->second;
      closing = n;
    }
  }
  motion->has_ratio = best != nullptr;
  if (best != nullptr) {
    const int next = (closing + 1) % 3, last = (closing + 2) % 3;
    const bool next_is_target = triangle.edges[next] == best->target;
    std::array<Vec3, 3> baselines;
    baselines[next] =
        walked[next] * (next_is_target ? std::exp(best->log_ratio) : 1.0);
    baselines[last] =
        walked[last] * (next_is_target ? 1.0 : std::exp(best->log_ratio));
    baselines[closing] = -(baselines[next] + baselines[last]);
    if (!(baselines[closing].norm() > 0)) return std::nullopt;
    motion->closure_rad = AngleBetween(baselines[closing], walked[closing]);
    return baselines;
  }
  if (SmallestAngleRad(walked) < RadFromDeg(options.min_angle_deg)) {
    return std::nullopt;
  }
  Mat3 directions;
  directions << walked[0], walked[1], walked[2];
  const Eigen::JacobiSVD<Mat3> svd(directions, Eigen::ComputeFullV);
  Vec3 lengths = svd.matrixV().col(2);
  if (lengths.sum() < 0) lengths = -lengths;
  if (!(lengths.minCoeff() > 0)) return std::nullopt;
  motion->closure_rad = 0;
  std::array<Vec3, 3> baselines;
  for (int n = 0; n < 3; ++n) {
    const Vec3 rest = -(lengths((n + 1) % 3) * walked[(n + 1) % 3] +
                        lengths((n + 2) % 3) * walked[(n + 2) % 3]);
    motion->closure_rad =
        std::max(motion->closure_rad, AngleBetween(rest, walked[n]));
    baselines[n] = lengths(n) * walked[n];
  }
  return baselines;
}

std::vector<TripletMotion> ConsistentTriplets(
    const TranslationProblem& problem, const TripletProgramOptions& options) {
  const auto ratios = BestRatios(problem);
  std::vector<TripletMotion> triplets;
  for (const Triangle& triangle : FindTriangles(problem)) {
    TripletMotion motion;
    const auto walked = Baselines(problem, triangle, ratios, options, &motion);
    if (!walked ||
        !(motion.closure_rad <= RadFromDeg(options.max_closure_deg))) {
      continue;
    }
    const double mean =
        ((*walked)[0].norm() + (*walked)[1].norm() + (*walked)[2].norm()) / 3;
    motion.edges = triangle.edges;
    for (int n = 0; n < 3; ++n) {
      motion.baselines[n] = triangle.signs[n] / mean * (*walked)[n];
    }
    triplets.push_back(motion);
  }
  std::stable_sort(triplets.begin(), triplets.end(),
                   [](const TripletMotion& a, const TripletMotion& b) {
                     return a.has_ratio != b.has_ratio
                                ? a.has_ratio
                                : a.closure_rad < b.closure_rad;
                   });
  return triplets;
}

}  // namespace

std::vector<std::vector<TripletMotion>> FindTripletBaselines(
    const TranslationProblem& problem, const TripletProgramOptions& options) {
  UnionFind sets(problem.edges.size());
  std::vector<int> count(problem.edges.size(), 0);
  std::vector<TripletMotion> kept;
  for (const TripletMotion& motion : ConsistentTriplets(problem, options)) {
    const auto& [a, b, c] = motion.edges;
    const bool joins_b = sets.Union(a, b);
    const bool joins = sets.Union(b, c) || joins_b;
    if (!joins && count[a] >= options.max_triplets_per_edge &&
        count[b] >= options.max_triplets_per_edge &&
        count[c] >= options.max_triplets_per_edge) {
      continue;
    }
    ++count[a];
    ++count[b];
    ++count[c];
    kept.push_back(motion);
  }

  struct Group {
    std::vector<TripletMotion> triplets;
    std::set<std::size_t> views;
  };
  std::map<std::size_t, Group> group_of_label;
  const std::vector<std::size_t> labels = sets.Labels();
  for (const TripletMotion& motion : kept) {
    Group& group = group_of_label[labels[motion.edges[0]]];
    group.triplets.push_back(motion);
    for (const std::size_t e : motion.edges) {
      group.views.insert(problem.edges[e].first);
      group.views.insert(problem.edges[e].second);
    }
  }
  std::vector<Group> groups;
  for (auto& entry : group_of_label) groups.push_back(std::move(entry.second));
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) {
                     return a.views.size() > b.views.size();
                   });
  std::vector<std::vector<TripletMotion>> triplets;
  for (Group& group : groups) triplets.push_back(std::move(group.triplets));
  return triplets;
}

}  // namespace lowlap
