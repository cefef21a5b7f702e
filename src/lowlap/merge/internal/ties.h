#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/merge/internal/trusted_pieces.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Whether the pieces hang together in the poses of a scene: whether all are in
/// one piece of these, by the relative poses and ratios in use, as CheckModel
/// tells for one model. Otherwise kInsufficientData says which do not, and what
/// was measured across the gap.
Status CheckTies(const Scene& scene, const PoseSummary& summary,
                 const std::vector<PartialModel>& models,
                 const std::vector<TrustedPiece>& pieces,
                 const PoseOptions& options, const RunContext& context);

}  // namespace lowlap
