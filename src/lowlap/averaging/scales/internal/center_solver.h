#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// C_second - C_first = length direction_in_world, up to an error of
/// `across_rad` radians in direction and exp(+-along) in length.
struct CenterEdge {
  std::size_t first = 0;
  std::size_t second = 0;
  Vec3 direction_in_world = Vec3::UnitX();
  double length = 1;
  double across_rad = 0.01;
  double along_log = 0.01;
};

/// Camera centres from differences of known direction and length: linear
/// least squares with the weight
///   W = (I - d d^T) / (length across)^2 + d d^T / (length along)^2
/// per edge, reweighted (Geman-McClure) until the robust optimum. Gauge: the
/// first view of every connected component is the origin; scale is that of the
/// lengths. A tree is reproduced exactly. kNumerical if a factorisation fails;
/// kCancelled.
Result<std::vector<Vec3>> SolveCenters(std::size_t num_views,
                                       const std::vector<CenterEdge>& edges,
                                       const RunContext& context = {},
                                       int max_iterations = 30);

}  // namespace lowlap
