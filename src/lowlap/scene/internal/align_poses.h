#pragma once

#include <vector>

#include "lowlap/geometry/similarity.h"
#include "lowlap/scene/view.h"

namespace lowlap {

/// The similarity that takes cameras to where the targets are, for drawing both
/// in one frame. A camera is the six tips of its axes, a tenth of the spread of
/// all centres long either way, and these are aligned (AlignPoints): the
/// centres decide, and where they say little of a turn, as on a line about it,
/// the rotations do.
///
/// Errors as AlignPoints, and kInsufficientData where centres coincide.
Result<Similarity> AlignPoses(const std::vector<Pose>& source,
                              const std::vector<Pose>& target);

}  // namespace lowlap
