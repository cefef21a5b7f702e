#pragma once

#include <vector>

#include "lowlap/synthetic/internal/pair_graph.h"
#include "lowlap/synthetic/internal/visibility.h"
#include "lowlap/synthetic/internal/world.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// Adds the features, the tracks, the matches of the relative poses (which
/// exist already) and the truth about the tracks.
void ObservePoints(const SyntheticOptions& options, const World& world,
                   const std::vector<Camera>& cameras, const PairGraph& graph,
                   const std::vector<std::vector<ViewId>>& views_of_points,
                   SyntheticScene* synthetic);
void ObserveLines(const SyntheticOptions& options, const World& world,
                  const std::vector<Camera>& cameras, const PairGraph& graph,
                  const std::vector<std::vector<ViewId>>& views_of_lines,
                  SyntheticScene* synthetic);

}  // namespace lowlap
