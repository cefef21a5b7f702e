#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Views whose mutual positions the directions of relative poses fix, up to one
/// scale and translation.
struct RigidGroup {
  std::vector<ViewId> views;    // sorted
  std::vector<ViewPair> edges;  // sorted
};

/// A view in which two or more rigid groups meet. Directions say nothing about
/// the groups' relative scale there: only ratios across the view do.
struct Hinge {
  ViewId view = kInvalidId;
  std::vector<std::size_t> groups;  // indices into RigidityReport::groups
};

struct RigidityReport {
  std::vector<RigidGroup> groups;  // most views first
  std::vector<Hinge> hinges;       // by view id
  /// Views of one connected component of the view graph, most views first.
  std::vector<std::vector<ViewId>> connected_components;
  /// Views without any relative pose.
  std::vector<ViewId> isolated_views;
};

/// What may join edges into one group.
enum class RigidityRule {
  /// The directions of all relative poses (parallel rigidity). The best case:
  /// it takes every direction for exact.
  kDirections,
  /// Triplets of views, each with a scale of its own, joined where they share
  /// an edge. A triplet counts if its three views share `min_shared_tracks`
  /// point tracks. This is what averaging over triplets stands on; groups that
  /// meet in one view have no common scale in it.
  kTriplets,
};

struct RigidityOptions {
  RigidityRule rule = RigidityRule::kDirections;
  /// For kTriplets; OpenMVG asks for 30.
  int min_shared_tracks = 30;
  /// For kDirections: triplets whose two relative poses have a known ratio of
  /// lengths. Triplets without these relative poses are ignored.
  std::vector<ViewTriplet> ratios;
};

/// Which parts of the view graph share a scale, before anything is solved.
///
/// kDirections: edges belong to one group iff their lengths are proportional in
/// every solution of C_j - C_i = s_ij d_ij, and s_jk = tau s_ij for the given
/// ratios. The test is generic: the null space of these equations for random
/// centres in a plane, since photographs are mostly taken at one height, where
/// a 4-cycle is not rigid. Triangles and ratios are merged first, so the null
/// space is computed only for what they leave. Cost: cubic in the number of
/// these parts that no single view separates; beyond 250 of them only parts
/// that share two views are merged.
///
/// kTriplets: edges outside every counted triplet are left out; their views are
/// isolated unless another edge holds them.
RigidityReport AnalyzeRigidity(const Scene& scene,
                               const RigidityOptions& options = {});

}  // namespace lowlap
