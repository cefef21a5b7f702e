#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

/// Views whose mutual positions the directions of relative poses fix, up to one
/// scale and translation.
struct RigidGroup {
  std::vector<ViewId> views;    // sorted
  std::vector<ViewPair> edges;  // sorted
};

/// A view in which two or more rigid groups meet. Directions say nothing about
/// the groups' relative scale there: only ratios across the view do.
struct ArticulationView {
  ViewId view = kInvalidId;
  std::vector<std::size_t> groups;  // indices into RigidityReport::groups
};

struct RigidityReport {
  std::vector<RigidGroup> groups;                    // most views first
  std::vector<ArticulationView> articulation_views;  // by view id
  /// Views of one connected component of the view graph, most views first.
  std::vector<std::vector<ViewId>> connected_components;
  /// Views without any relative pose.
  std::vector<ViewId> isolated_views;
};

/// Which parts of a view graph share a scale by the directions of their
/// relative poses (parallel rigidity), before anything is solved. `ratios`:
/// triplets whose two relative poses have a known ratio of lengths; those
/// without these relative poses are ignored. The best case: every direction is
/// exact.
///
/// `flat`: triangles, by end, middle and other end, that are known to lie on a
/// line. Their directions say only that the lengths add up: two fix the third,
/// and until then the edge of the two ends fixes nothing.
///
/// `narrow`: triangles, by near view, far view and other near view, whose near
/// views are too close to one another, for how well directions are known, to
/// tell how far the far one is. The long edges are as long as one another,
/// unless the triangle is flat as well; the short one takes no scale from them.
/// Where these are known to be in proportion, and nothing else holds the short
/// one, the near views count as one place.
///
/// Edges belong to one group iff their lengths are proportional in every
/// solution of C_j - C_i = s_ij d_ij, and s_jk = tau s_ij for the ratios. The
/// test is generic: the null space of these equations for random centres in a
/// plane, since photographs are mostly taken at one height, where a 4-cycle is
/// not rigid. Triangles and ratios are merged first, so the null space is
/// computed only for what they leave. Cost: cubic in the number of these parts
/// that no single view separates; beyond 250 of them only parts that share two
/// views are merged.
RigidityReport AnalyzeRigidity(const ViewGraph& graph,
                               const std::vector<ViewTriplet>& ratios = {},
                               const std::vector<ViewTriplet>& flat = {},
                               const std::vector<ViewTriplet>& narrow = {});

/// What averaging over triplets stands on: triplets of views, each with a scale
/// of its own, joined where they share an edge. A triplet counts if its three
/// views share `min_shared_tracks` point tracks (OpenMVG asks for 30); groups
/// that meet in one view have no common scale in it. Edges outside every
/// counted triplet are left out; their views are isolated unless another edge
/// holds them.
RigidityReport AnalyzeTripletRigidity(const Scene& scene,
                                      int min_shared_tracks = 30);

}  // namespace lowlap
