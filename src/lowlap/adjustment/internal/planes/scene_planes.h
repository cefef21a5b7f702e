#pragma once

#include <vector>

#include "lowlap/adjustment/internal/planes/free_landmark.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// The planes of the scene, a contrario. A hypothesis is the plane of two lines
/// that a coplanar pair joins. On a ladder of thicknesses t, let n landmarks be
/// known across it to better than t, and k of them lie within 2 t of it; E is
/// how far the scene reaches across the plane, and what is not on it lies
/// anywhere there:
///   NFA = T C(n - 2, k - 2) (4 t / E)^(k - 2),
/// T the number of hypotheses times that of thicknesses. The plane of least NFA
/// is fitted to its members, which then belong to no other one, and so on while
/// the NFA is below 1.
///
/// The thickness of a plane is what its members' distances have beyond their
/// own deviations: real walls are not flat. At least a quarter of the median
/// deviation.
Result<std::vector<PlaneState>> FindPlanes(
    const std::vector<FreeLandmark>& landmarks, const StructureState& state,
    const RunContext& context);

}  // namespace lowlap
