#pragma once

#include <cmath>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

inline ViewPair ViewsOf(const TranslationProblem& problem,
                        const DirectionEdge& edge) {
  return OrderedPair(problem.views[edge.first], problem.views[edge.second]);
}

/// Whether both its views are in component 0.
inline bool IsPlaced(const TranslationSolution& solution,
                     const DirectionEdge& edge) {
  return solution.component[edge.first] == 0 &&
         solution.component[edge.second] == 0;
}

/// Between the views of the edge, in the world.
inline Vec3 BaselineOf(const TranslationSolution& solution,
                       const DirectionEdge& edge) {
  return solution.center_in_world[edge.second] -
         solution.center_in_world[edge.first];
}

/// The angle between a measured direction and that of the centres; pi if these
/// coincide.
inline double DirectionErrorRad(const TranslationSolution& solution,
                                const DirectionEdge& edge) {
  const Vec3 baseline = BaselineOf(solution, edge);
  return baseline.norm() > 0 ? AngleBetween(baseline, edge.direction_in_world)
                             : kPi;
}

/// How far a measured log ratio is from that of the centres. Its views must be
/// of one component.
inline double LogRatioError(const TranslationProblem& problem,
                            const TranslationSolution& solution,
                            const RatioMeasurement& ratio) {
  const double before =
      BaselineOf(solution, problem.edges[ratio.reference]).norm();
  const double after = BaselineOf(solution, problem.edges[ratio.target]).norm();
  return std::abs(std::log(after / before) - ratio.log_ratio);
}

}  // namespace lowlap
