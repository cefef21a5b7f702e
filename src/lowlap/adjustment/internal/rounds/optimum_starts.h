#pragma once

#include <string>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/adjustment/internal/rounds/optimum_search.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Where an adjustment ended from another start, explaining what was measured
/// as well as the one that is taken, to within one observation.
struct Rival {
  std::string start;
  CameraSet cameras;
};

/// The optimum of an adjustment (OptimumSearch).
///
/// Tracks of two views bear out the relative pose that chose them, true or not.
/// Where most observations in use are of such landmarks, three starts are
/// searched, at the same time: with points and lines, with the lines alone at
/// first, and with the points alone at first, so that what is false in one kind
/// does not lead the other astray. The directions of the scene hold all three.
/// The end that explains most of what was measured is taken (MeasurementCost);
/// those that do so as well are returned.
///
/// `optimum` holds the start, and then the result; the summary gets what the
/// solves were. Errors: as SolveOnce.
Result<std::vector<Rival>> FindOptimum(const AdjustmentOptions& options,
                                       const RunContext& context,
                                       const Scene& scene, Optimum* optimum,
                                       AdjustmentSummary* summary);

}  // namespace lowlap
