#pragma once

#include <cstddef>
#include <map>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/points/patch_alignment.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct SubpixelSummary {
  std::size_t observations = 0;  // of all tracks, less the references
  std::size_t refined = 0;
};

/// Moves the observations of every point track (scene->point_tracks) to where
/// their image shows the same as a common reference: the observation whose blob
/// is largest, hence best resolved, keeps its place, and the patch around it is
/// aligned with every other image of the track (AlignPatch). An observation
/// that cannot be aligned keeps its place too. Because a feature has one
/// position, all pairs see the same one, and a track does not contradict
/// itself. Writes scene->features[...].points_px and nothing else.
///
/// `detected` holds the keypoints of scene->features, in the same order. Reads
/// every image of a tracked view twice (Scene::ImagePath; errors as there), one
/// per thread; keeps 1.5 kB per track. The same for any number of threads.
Result<SubpixelSummary> RefinePointTracks(
    const std::map<ViewId, DetectedFeatures>& detected,
    const PatchAlignmentOptions& options, const RunContext& context,
    Scene* scene);

}  // namespace lowlap
