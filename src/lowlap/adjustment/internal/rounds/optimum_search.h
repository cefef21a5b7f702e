#pragma once

#include <functional>
#include <string>
#include <utility>
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
  SolveOutcome last;
  bool at_rest = false;  // a further round would change next to nothing
};

/// Where an adjustment ended from another start, explaining what was measured
/// as well as the one that is taken, to within one observation.
struct Rival {
  std::string start;
  CameraSet cameras;
};

/// The solves and rounds of AdjustScene.
///
/// What is out of use has no say: cameras that have drifted put the very
/// observations out of use that would bring them back, of landmarks that three
/// views see, and rest in an optimum of their own. So once there is one, others
/// are looked for:
///  - "again": the gate of such tracks is widened to three, six, and nine
///    thresholds, and the search goes on from where that leads;
///  - "lines first", "points first": from the start, with one kind alone, and
///    then with both, so that what is false in one kind does not lead the other
///    astray. Only where most observations are of landmarks that two views see:
///    the relative poses that chose those have decided what they bear out.
/// What explains most of what was measured is taken (MeasurementCost). Other
/// starts that do so as well, to within one observation, are rivals.
class OptimumSearch {
 public:
  /// `scene` and all others must outlive this. `optimum` holds the start.
  OptimumSearch(const AdjustmentOptions& options, const RunContext& context,
                const Scene& scene, Optimum* optimum,
                AdjustmentSummary* summary);

  /// Writes to the summary what the solves were. Errors as SolveOnce.
  Status Run();

  const std::vector<Rival>& rivals() const { return rivals_; }

 private:
  Status Prepare();
  Status FirstSolves();
  Status SettleObservations();
  Status TiePlanes();
  /// From settled observations to the best that is reached from there, with
  /// planes.
  Status Complete();
  Status TryOtherStarts(const Optimum& start);
  /// From the start, with the kinds of these options alone, then with all.
  Status StartWith(const AdjustmentOptions& kind);
  Status Attempt(const std::string& name,
                 const std::function<Status()>& search);
  Result<bool> WidenGate();
  Status Choose(const std::vector<std::pair<std::string, Optimum>>& reached);
  /// At the noise of `scale`.
  Result<double> CostOf(const Optimum& optimum, const Optimum& scale) const;
  Result<bool> ExplainsMoreThan(const Optimum& other) const;

  /// To the tolerance of the options, or to this one if that is greater.
  Status Solve(const std::string& stage, bool fixed_rotations,
               double least_tolerance);
  void EstimateNoise();
  Status FindDirections();
  Status LinkPlanes();
  Result<ObservationChanges> Update(const ObservationUpdate& update);

  const AdjustmentOptions& options_;
  const RunContext& context_;
  const Scene& scene_;
  Optimum* now_;
  AdjustmentSummary* summary_;
  std::vector<DirectionSight> sights_;
  std::string stage_prefix_;
  std::vector<Rival> rivals_;
};

}  // namespace lowlap
