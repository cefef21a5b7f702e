#pragma once

#include <vector>

#include "lowlap/adjustment/internal/planes/plane_fit.h"
#include "lowlap/adjustment/internal/planes/scene_reach.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// A plane among the landmarks that two poses share. Within one relative pose
/// nothing drifts: a wall is plane there to its own thickness, however badly
/// the cameras are joined to others.
struct Facet {
  Plane plane;
  double thickness = 0;
  double log10_nfa = 0;
  Vec3 center = Vec3::Zero();
  std::vector<int> members;  // indices of landmarks
};

/// The facets of every pair of poses, a contrario; the best first. A hypothesis
/// is the plane of three landmarks, drawn. On a ladder of thicknesses t, let n
/// landmarks of the pair be known across it to better than t, and k of them lie
/// within 2 t of it; E is how far the scene reaches across the plane, and what
/// is not on it lies anywhere there:
///   NFA = T C(n - 3, k - 3) (4 t / E)^(k - 3),
/// T the number of hypotheses times that of thicknesses. The plane of least NFA
/// is fitted to its members, which then belong to no other one of the pair, and
/// so on while the NFA is below 1.
///
/// The thickness is what the members' distances have beyond their own
/// deviations: real walls are not flat. At least a quarter of the median
/// deviation.
Result<std::vector<Facet>> FindFacets(
    const std::vector<FreeLandmark>& landmarks, const SceneReach& reach,
    const RunContext& context);

}  // namespace lowlap
