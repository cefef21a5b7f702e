#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "test_scene.h"

namespace lowlap::test {

// Only lines of three views carry the scale from pair to pair.
inline TestScene ChainOfLines(std::uint64_t seed) {
  TestSceneOptions options;
  options.num_views = 7;
  options.num_points = 600;
  options.max_point_views = 2;
  options.num_lines = 200;
  options.max_line_views = 3;
  options.noise_px = 0.1;
  options.seed = seed;
  return MakeTestScene(options);
}

// The paper's adjustment.
inline AdjustmentOptions WithPairs() {
  AdjustmentOptions options;
  options.coplanar_ties = CoplanarTies::kPairs;
  return options;
}

inline bool SearchedFrom(const std::string& name,
                         const AdjustmentSummary& summary) {
  return std::any_of(summary.solves.begin(), summary.solves.end(),
                     [&](const SolveReport& report) {
                       return report.stage.rfind(name + ": ", 0) == 0;
                     });
}

}  // namespace lowlap::test
