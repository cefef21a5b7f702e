#pragma once

#include <vector>

#include "lowlap/adjustment/internal/planes/free_landmark.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// The planes of the scene. Facets of different pairs (FindFacets) that face
/// the same way, to within what badly joined cameras drift, are one plane; it
/// is fitted to the members of all, and what else lies on it, and is known as
/// well as it is thick, joins them.
///
/// A facet is tied as loosely as it is off: one that two cameras carried away
/// by many thicknesses pulls them from there, and is held the tighter the
/// closer it comes. What is not on the plane at all, the front of a box before
/// a wall, stays off where its cameras are known, and hardly pulls.
///
/// What a wall has beyond the errors of its members may be common to them all,
/// and no number of ties averages it out: the plane bows with them, by about as
/// much as it is thick.
Result<std::vector<PlaneState>> FindPlanes(
    const std::vector<FreeLandmark>& landmarks, const RunContext& context);

}  // namespace lowlap
