#pragma once

#include <string>
#include <vector>

#include "lowlap/scene/scene.h"

namespace lowlap::openmvg {

/// What OpenMVG can load of a scene, and what had to change on the way.
struct PreparedScene {
  Scene scene;
  std::vector<std::string> notes;  // one sentence per kind of change
};

/// The part of a scene that OpenMVG's formats hold and its reader accepts:
/// - views, intrinsics, poses, structure and control points only;
/// - no intrinsic and no pose that no view uses (OpenMVG refuses the whole
/// file);
/// - one focal length, the geometric mean of fx and fy (OpenMVG has no second
/// one; the
///   loss is noted with its size in per cent);
/// - no observation from a view without a pose or an intrinsic, and no landmark
///   with fewer than two observations left (OpenMVG's exporters assume both).
/// All views are kept, posed or not.
PreparedScene PrepareForOpenMvg(const Scene& scene);

}  // namespace lowlap::openmvg
