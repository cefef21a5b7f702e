#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// DrawScene as a Wavefront OBJ: `v x y z` for vertices, `l a b` for edges and
/// `p a` for points and lone cameras, vertices counted from 1. The segments of
/// lines come first, all their vertices before all their edges: programs that
/// know segments alone (LIMAP) read two vertices each up to the first line
/// that is no `v`. kInvalidScene for a number that is not finite.
Result<std::string> FormatObj(const Scene& scene);

}  // namespace lowlap
