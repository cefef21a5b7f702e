#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "averaging/random_problem.h"
#include "lowlap/core/internal/median.h"
#include "support/random_vectors.h"

namespace lowlap {

/// How the views of a big graph see one another.
enum class GraphShape {
  kStreet,  // every view with the four next ones: errors add up on the way
  kTown,    // views in a square, each with its nearest
  kRandom,  // views in a box, each with any other: no order keeps it sparse
};

struct BigGraphOptions {
  GraphShape shape = GraphShape::kTown;
  std::size_t num_views = 5000;
  std::size_t num_edges = 20000;
  std::size_t num_ratios = 60000;
  double wrong_ratio_share = 0.2;
  double direction_stddev_rad = 0.005;
  double ratio_stddev = 0.03;
  std::uint64_t seed = 1;
};

/// A simulated problem, and the same without the wrong ratios.
struct BigGraph {
  RandomProblem made;
  TranslationProblem oracle;
};

inline std::vector<std::pair<std::size_t, std::size_t>> PairsOfShape(
    const BigGraphOptions& options, const std::vector<Vec3>& centers) {
  const std::size_t n = options.num_views;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a + 1 < n; ++a) pairs.insert({a, a + 1});
  if (options.shape == GraphShape::kStreet) {
    for (std::size_t step = 2; pairs.size() < options.num_edges; ++step) {
      for (std::size_t a = 0; a + step < n; ++a) {
        if (pairs.size() < options.num_edges) pairs.insert({a, a + step});
      }
    }
  } else if (options.shape == GraphShape::kRandom) {
    Random random(options.seed + 1);
    const auto any = [&]() -> std::size_t {
      return random.Index(static_cast<std::uint32_t>(n));
    };
    while (pairs.size() < options.num_edges) {
      const std::size_t a = any(), b = any();
      if (a != b) pairs.insert({std::min(a, b), std::max(a, b)});
    }
  } else {
    // All pairs of a town, nearest first.
    std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> near;
    const double reach = 3.0;
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = a + 1; b < n; ++b) {
        const double distance = (centers[a] - centers[b]).norm();
        if (distance < reach) near.push_back({distance, {a, b}});
      }
    }
    std::sort(near.begin(), near.end());
    for (const auto& entry : near) {
      if (pairs.size() < options.num_edges) pairs.insert(entry.second);
    }
  }
  return {pairs.begin(), pairs.end()};
}

/// Centres a metre apart or so. A town is walked through in rows, back and
/// forth, so that consecutive views are neighbours.
inline std::vector<Vec3> CentersOfShape(const BigGraphOptions& options,
                                        Random* random) {
  const std::size_t n = options.num_views;
  const std::size_t side =
      static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n))));
  std::vector<Vec3> centers;
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 center = RandomVector(random, 0.4);
    if (options.shape == GraphShape::kStreet) {
      center.x() += static_cast<double>(i);
    } else if (options.shape == GraphShape::kRandom) {
      const double extent = std::cbrt(static_cast<double>(n));
      center = RandomVector(random, extent / 2);
    } else {
      const std::size_t row = i / side, place = i % side;
      center.x() += static_cast<double>(row % 2 ? side - 1 - place : place);
      center.z() += static_cast<double>(row);
    }
    centers.push_back(center);
  }
  return centers;
}

inline BigGraph MakeBigGraph(const BigGraphOptions& options) {
  Random random(options.seed);
  BigGraph graph;
  RandomProblem& made = graph.made;
  made.centers = CentersOfShape(options, &random);
  TranslationProblem& problem = made.problem;
  std::vector<std::vector<std::size_t>> incident(options.num_views);
  for (std::size_t i = 0; i < options.num_views; ++i) {
    problem.views.push_back(static_cast<ViewId>(i));
    problem.cam_from_world.push_back(Mat3::Identity());
  }
  for (const auto& [a, b] : PairsOfShape(options, made.centers)) {
    DirectionEdge edge;
    edge.first = a;
    edge.second = b;
    const Vec3 direction = (made.centers[b] - made.centers[a]).normalized();
    const Vec3 error =
        testing::GaussianVec3(random, options.direction_stddev_rad);
    edge.direction_in_world =
        (direction + error - direction * direction.dot(error)).normalized();
    edge.stddev_rad = options.direction_stddev_rad;
    incident[a].push_back(problem.edges.size());
    incident[b].push_back(problem.edges.size());
    problem.edges.push_back(edge);
  }
  std::vector<std::pair<std::size_t, std::size_t>> joins;
  for (const std::vector<std::size_t>& edges : incident) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = i + 1; j < edges.size(); ++j) {
        joins.push_back({edges[i], edges[j]});
      }
    }
  }
  // A random choice of the wanted size.
  for (std::size_t i = 0; i < joins.size(); ++i) {
    const std::size_t left = joins.size() - i;
    std::swap(joins[i],
              joins[i + random.Index(static_cast<std::uint32_t>(left))]);
  }
  joins.resize(std::min(joins.size(), options.num_ratios));
  for (const auto& [reference, target] : joins) {
    made.AddRatio(reference, target, random.Gaussian(options.ratio_stddev));
    RatioMeasurement& ratio = problem.ratios.back();
    ratio.stddev = options.ratio_stddev;
    // What is wrong is as sure of itself as what is right.
    ratio.log10_nfa = random.Uniform(-30, -5);
    if (random.Uniform() < options.wrong_ratio_share) {
      const double error = random.Uniform(0.2, 2.0);
      ratio.log_ratio += random.Uniform() < 0.5 ? -error : error;
    } else {
      graph.oracle.ratios.push_back(ratio);
    }
  }
  graph.oracle.views = problem.views;
  graph.oracle.cam_from_world = problem.cam_from_world;
  graph.oracle.edges = problem.edges;
  return graph;
}

/// Median distance to the true centres after scale (the median over the edges)
/// and translation (the median over the views) are removed, so that a few views
/// far off have no say in it; views that are not in component 0 count as
/// infinitely far.
inline double MedianCenterError(const RandomProblem& made,
                                const TranslationSolution& solution) {
  const auto is_placed = [&](std::size_t n) {
    return solution.component[n] == 0;
  };
  std::vector<double> scales;
  for (const DirectionEdge& edge : made.problem.edges) {
    if (!is_placed(edge.first) || !is_placed(edge.second)) continue;
    scales.push_back(
        (made.centers[edge.second] - made.centers[edge.first]).norm() /
        (solution.center_in_world[edge.second] -
         solution.center_in_world[edge.first])
            .norm());
  }
  const double scale = Median(std::move(scales));
  const auto offset = [&](std::size_t n) -> Vec3 {
    return made.centers[n] - scale * solution.center_in_world[n];
  };
  Vec3 shift;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> offsets;
    for (std::size_t n = 0; n < made.centers.size(); ++n) {
      if (is_placed(n)) offsets.push_back(offset(n)(axis));
    }
    shift(axis) = Median(std::move(offsets));
  }
  std::vector<double> errors;
  for (std::size_t n = 0; n < made.centers.size(); ++n) {
    errors.push_back(is_placed(n) ? (offset(n) - shift).norm() : HUGE_VAL);
  }
  return Median(std::move(errors));
}

}  // namespace lowlap
