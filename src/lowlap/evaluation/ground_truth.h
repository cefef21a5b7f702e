#pragma once

#include <map>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// True poses by view id: the form in which every evaluation takes them. The
/// world frame, its unit and its scale are the truth's own.
using GroundTruth = std::map<ViewId, Pose>;

/// Assigns true poses to the views of a scene by image name: the path below
/// the image folder if it matches, else the file name, else the file name
/// without extension. Views without truth are left out.
///
/// Errors: kInvalidScene if a name fits two views equally well;
/// kInsufficientData if no view has a truth.
Result<GroundTruth> GroundTruthByName(
    const Scene& scene, const std::map<std::string, Pose>& pose_by_image);

/// The poses of a scene (a simulated one, a reference solution) as truth.
GroundTruth GroundTruthFromScene(const Scene& truth);

/// The same for the views of another scene: by image name if no two of its
/// posed views share one and a name occurs in the other scene, else by view id.
/// kInvalidScene if a name fits two views of the other scene equally well.
Result<GroundTruth> GroundTruthFromScene(const Scene& truth,
                                         const Scene& scene);

}  // namespace lowlap
