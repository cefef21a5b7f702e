#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The intrinsics of photographs: a scene of any format, or a `K.txt`, the 3x3
/// calibration matrix of all of them.
Result<IntrinsicSource> ReadIntrinsicSource(const std::string& path);

/// The true poses of a folder of Strecha's .camera files (or of the one that
/// holds it as gt_dense_cameras), matched by image name; or of a scene of any
/// format or the reference cameras of a problem folder of 1DSfM, by name or by
/// id (GroundTruthFromScene). kInsufficientData if no view of the scene is
/// among them.
Result<GroundTruth> ReadGroundTruth(const std::string& path,
                                    const Scene& scene);

}  // namespace lowlap
