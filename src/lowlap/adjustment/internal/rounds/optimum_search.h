#pragma once

#include <string>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/adjustment/internal/directions/scene_directions.h"
#include "lowlap/adjustment/internal/rounds/outlier_round.h"
#include "lowlap/adjustment/internal/rounds/solve.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Where an adjustment is.
struct Optimum {
  CameraSet cameras;
  StructureState state;
  NoiseLevels noise;
  /// As in AdjustmentSummary::point_shape_exponent.
  double point_shape_exponent = 0;
  /// Of which the directions of the state are made; none where they are not
  /// used.
  std::vector<DirectionSight> direction_sights;
  SolveOutcome last;
  bool at_rest = false;  // a further round would change next to nothing
};

/// Where an adjustment of the scene starts: all that it holds of the kinds in
/// use.
Optimum LoadOptimum(const Scene& scene, const AdjustmentOptions& options);

/// MeasurementCost of an optimum, at the noise of `scale`.
Result<double> CostOf(const Optimum& optimum, const Optimum& scale,
                      const RunContext& context);

/// The solves and rounds of an adjustment from one start.
///
/// What is out of use has no say: cameras that have drifted put the very
/// observations out of use that would bring them back, of landmarks that three
/// views see, and rest in an optimum of their own. So once there is one, the
/// gate of such tracks is widened to three, six, and nine thresholds, and the
/// search goes on from where that leads. Where it ends is taken if that
/// explains more of what was measured (MeasurementCost).
///
/// What the solves were goes to the summary; their stages begin with a prefix.
/// Errors of all steps: as SolveOnce.
class OptimumSearch {
 public:
  /// `scene` and all others must outlive this. `optimum` holds the start, and
  /// then where the search is.
  OptimumSearch(const AdjustmentOptions& options, const RunContext& context,
                const Scene& scene, Optimum* optimum,
                AdjustmentSummary* summary,
                const std::string& stage_prefix = {});

  /// What the start says: noise, directions, and the pairs to begin with.
  Status Prepare();
  /// From there until the observations are at rest.
  Status Settle();
  /// From there to the best that is reached, with planes.
  Status Complete();
  /// All three.
  Status Run();
  /// All of it, first with the kinds of these options alone.
  Status CompleteFrom(const AdjustmentOptions& kind);
  /// To the tolerance of the options.
  Status Finish();

 private:
  Status FirstSolves();
  Status SettleObservations();
  Status TiePlanes();
  Status SearchAgain(const Optimum& settled, Optimum* best);
  Result<bool> WidenGate();
  Result<bool> ExplainsMoreThan(const Optimum& other) const;

  /// To the tolerance of the options, or to this one if that is greater.
  Status Solve(const std::string& stage, bool fixed_rotations,
               double least_tolerance);
  void EstimateNoise();
  Status FindDirections();
  void RegroupDirections();
  Status LinkPlanes();
  Result<ObservationChanges> Update(const ObservationUpdate& update);

  const AdjustmentOptions& options_;
  const RunContext& context_;
  const Scene& scene_;
  Optimum* now_;
  AdjustmentSummary* summary_;
  std::string stage_prefix_;
};

}  // namespace lowlap
