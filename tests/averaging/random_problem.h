#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

inline Vec3 RandomVector(Random* random, double size) {
  return {random->Uniform(-size, size), random->Uniform(-size, size),
          random->Uniform(-size, size)};
}

/// Draws its last coordinate first: in one order for every compiler.
inline Vec3 GaussianVector(Random* random, double stddev) {
  const double z = random->Gaussian(stddev), y = random->Gaussian(stddev);
  return {random->Gaussian(stddev), y, z};
}

inline Mat3 RandomRotation(Random* random) {
  return RotationFromAngleAxis(RandomVector(random, 1.5));
}

/// An exact translation problem over random centres: the given edges, and a
/// ratio for every pair of edges that share a view.
struct RandomProblem {
  TranslationProblem problem;
  std::vector<Vec3> centers;

  double TrueLogRatio(std::size_t reference, std::size_t target) const {
    const auto length = [&](std::size_t e) {
      const DirectionEdge& edge = problem.edges[e];
      return (centers[edge.second] - centers[edge.first]).norm();
    };
    return std::log(length(target) / length(reference));
  }

  void AddRatio(std::size_t reference, std::size_t target, double error = 0.0) {
    RatioMeasurement ratio;
    ratio.reference = reference;
    ratio.target = target;
    ratio.log_ratio = TrueLogRatio(reference, target) + error;
    ratio.stddev = 0.01;
    ratio.log10_nfa = -20.0 - static_cast<double>(problem.ratios.size() % 7);
    problem.ratios.push_back(ratio);
  }
};

inline RandomProblem MakeRandomProblem(
    std::size_t num_views,
    const std::vector<std::pair<std::size_t, std::size_t>>& edges,
    std::uint64_t seed, bool with_ratios = true) {
  RandomProblem made;
  Random random(seed);
  for (std::size_t n = 0; n < num_views; ++n) {
    made.problem.views.push_back(static_cast<ViewId>(10 + 3 * n));
    made.problem.cam_from_world.push_back(RandomRotation(&random));
    made.centers.push_back(RandomVector(&random, 5.0));
  }
  for (const auto& [first, second] : edges) {
    DirectionEdge edge;
    edge.first = first;
    edge.second = second;
    edge.direction_in_world =
        (made.centers[second] - made.centers[first]).normalized();
    made.problem.edges.push_back(edge);
  }
  if (!with_ratios) return made;
  for (std::size_t a = 0; a < edges.size(); ++a) {
    for (std::size_t b = a + 1; b < edges.size(); ++b) {
      const auto& [a1, a2] = edges[a];
      const auto& [b1, b2] = edges[b];
      if (a1 == b1 || a1 == b2 || a2 == b1 || a2 == b2) made.AddRatio(a, b);
    }
  }
  return made;
}

/// Largest distance after scale and translation are removed, relative to the
/// extent; only views with `placed` count.
inline double GaugeFreeError(const std::vector<Vec3>& truth,
                             const std::vector<Vec3>& solved,
                             const std::vector<bool>& placed) {
  Vec3 truth_mean = Vec3::Zero(), solved_mean = Vec3::Zero();
  double count = 0;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    if (!placed[n]) continue;
    truth_mean += truth[n];
    solved_mean += solved[n];
    ++count;
  }
  truth_mean /= count;
  solved_mean /= count;
  double dot = 0, square = 0, extent = 0;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    if (!placed[n]) continue;
    dot += (truth[n] - truth_mean).dot(solved[n] - solved_mean);
    square += (solved[n] - solved_mean).squaredNorm();
    extent = std::max(extent, (truth[n] - truth_mean).norm());
  }
  double worst = 0;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    if (!placed[n]) continue;
    const Vec3 fitted = truth_mean + (dot / square) * (solved[n] - solved_mean);
    worst = std::max(worst, (truth[n] - fitted).norm());
  }
  return worst / extent;
}

/// That of the views in the first component.
inline double ErrorOfFirstPart(const RandomProblem& made,
                               const TranslationSolution& solution) {
  std::vector<bool> placed;
  for (const int component : solution.component) {
    placed.push_back(component == 0);
  }
  return GaugeFreeError(made.centers, solution.center_in_world, placed);
}

}  // namespace lowlap
