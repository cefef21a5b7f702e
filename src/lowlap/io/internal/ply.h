#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What a scene looks like as a binary little-endian PLY for viewers (MeshLab,
/// CloudCompare, Blender), in world coordinates.
///
/// Vertices (double x y z, uchar red green blue) come in this order: the points
/// of `structure` (white), the two ends of every line of `line_structure`
/// (orange), and five per posed view that has an intrinsic: the centre and the
/// corners of a small viewing frustum (green). Edges (int vertex1 vertex2)
/// draw the segments and the frusta. A view without intrinsic, and a spherical
/// one, is its centre alone.
///
/// The frusta are a quarter as deep as the median distance from a camera centre
/// to its nearest neighbour. kInvalidScene for a number that is not finite.
Result<std::string> FormatPly(const Scene& scene);

}  // namespace lowlap
