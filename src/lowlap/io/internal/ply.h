#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// DrawScene as a binary little-endian PLY for viewers (MeshLab, CloudCompare,
/// Blender): vertices (double x y z, uchar red green blue), white for points,
/// orange for lines, green for cameras; edges (int vertex1 vertex2, colour).
/// kInvalidScene for a number that is not finite.
Result<std::string> FormatPly(const Scene& scene);

}  // namespace lowlap
