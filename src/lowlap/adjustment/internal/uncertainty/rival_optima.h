#pragma once

#include <string>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/adjustment/internal/rounds/optimum_starts.h"
#include "lowlap/adjustment/internal/uncertainty/center_covariances.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Those of the rivals that are elsewhere: with the centres that are outside
/// the 95 % regions of the covariances. Each adds to `uncertainty` how far it
/// is (CenterShift).
std::vector<RivalOptimum> AddRivals(const AdjustmentOptions& options,
                                    const std::vector<Rival>& rivals,
                                    const CameraSet& cameras,
                                    const StructureState& state,
                                    CenterUncertainty* uncertainty);

/// A sentence for each of the summary's rivals, which names the views.
std::vector<std::string> DescribeRivals(const Scene& scene,
                                        const AdjustmentSummary& summary);

}  // namespace lowlap
