#pragma once

#include <vector>

#include "lowlap/averaging/reliability_warning.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// WarningReason::kLostFeatures: views with a pose and an intrinsic of whose
/// features fewer than half are observations of a landmark. Features are those
/// on point tracks over two such views or more, and on line tracks over three
/// or more (two views of a line fit any poses, however many pieces of it they
/// have); the pieces of a line in one view count once. Views without any have
/// no entry.
std::vector<ReliabilityWarning> FindLostFeatures(const Scene& scene);

}  // namespace lowlap
