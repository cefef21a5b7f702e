#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lowlap/averaging/rigidity/internal/rigidity.h"
#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

/// When a meaningful ratio is too weak to rely on where nothing else checks it.
struct DiagnosisOptions {
  int min_inliers = 5;        // of all kinds together
  double max_log10_nfa = -3;  // one in a thousand is chance
  double max_stddev = 0.1;    // of the log ratio: a tenth of the length
  /// Tracks that a triplet must share to count for averaging over triplets.
  int min_shared_tracks = 30;

  Status Validate() const;
};

/// A camera whose ratios are all that joins two parts of a scale group: without
/// them the parts have scales of their own.
struct ScaleArticulation {
  ViewId view = kInvalidId;
  /// Each part's views without the camera, the largest first.
  std::vector<std::vector<ViewId>> parts;
  /// The ratios across the camera that join parts, as indices into
  /// the scale ratios, most meaningful first.
  std::vector<std::size_t> ratios;
  /// Without those that are too weak to rely on, parts come apart.
  bool is_weak = false;
};

/// Views that share no scale with the largest group.
struct FloatingPart {
  /// Sorted. Groups that cameras join to one another, and none of them to the
  /// largest group, are one part, besides which all but their largest are parts
  /// of their own.
  std::vector<ViewId> views;
  /// A camera that it shares with another group, the largest if there is a
  /// choice (which may float too). kInvalidId: it shares none.
  ViewId meets_in = kInvalidId;
  /// What lies on either side of the gap. With `meets_in`: the views of that
  /// other group and of the part that have the most matches with it. Without:
  /// the view of the largest group and that of the part whose ids are nearest.
  ViewId near_group = kInvalidId;
  ViewId near_part = kInvalidId;
  /// The best ratio between the two across `meets_in` that was estimated and
  /// is not meaningful, as an index into the scale ratios.
  std::optional<std::size_t> rejected_ratio;
};

/// What global averaging over point triplets returns for the same graph, as in
/// OpenMVG, which keeps the largest connected set of triplets and does not ask
/// whether they share a scale.
struct TripletPrediction {
  std::vector<ViewId> kept;
  std::vector<ViewId> lost;
  /// The kept views by common scale; more than one: they are put together at
  /// an arbitrary scale, without a warning.
  std::vector<RigidGroup> groups;
  std::vector<ArticulationView>
      articulation_views;  // where they meet; indices into groups

  bool IsGlued() const { return groups.size() > 1; }
};

/// What directions and ratios say about common scales.
struct ScaleDiagnosis {
  /// Scale groups by directions alone; by directions and ratios.
  RigidityReport by_directions;
  RigidityReport by_ratios;
  /// By directions and those ratios that are strong enough to rely on alone.
  RigidityReport by_strong_ratios;
  /// The weak ratios between groups of by_strong_ratios that are one in
  /// by_ratios, as indices into the scale ratios, most meaningful first.
  std::vector<std::size_t> weak_ratios;
  std::vector<ScaleArticulation> articulation_views;  // by camera
};

struct Diagnosis : ScaleDiagnosis {
  std::vector<FloatingPart> floating;  // most views first
  TripletPrediction by_triplets;

  /// One scale for all views, without any weak ratio.
  bool IsFirm() const;
};

/// Tells before anything is solved which views share one scale. A common scale
/// comes from directions of relative poses (parallel rigidity) and from ratios
/// of two relative poses across their common camera; see AnalyzeRigidity for
/// the equations and their null space. Ratios in use are those of
/// scene.scale_ratios that are meaningful. Nothing of the solution (poses,
/// structure) and no true camera is looked at, and values of ratios are not
/// compared with one another: a diagnosis says what can be known, not whether
/// measurements are right.
///
/// Cost: that of AnalyzeRigidity, and one pass over the ratios for every camera
/// in which groups of by_directions meet.
///
/// Errors: invalid options; kInvalidScene if a ratio names a relative pose that
/// the scene does not have.
Result<Diagnosis> Diagnose(const Scene& scene,
                           const DiagnosisOptions& options = {});

/// The part that needs a graph and ratios alone; ratios whose relative poses
/// the graph does not have are an error.
Result<ScaleDiagnosis> DiagnoseScales(const ViewGraph& graph,
                                      const std::vector<ScaleRatio>& ratios,
                                      const DiagnosisOptions& options = {});

/// The prediction alone.
TripletPrediction PredictTripletAveraging(const Scene& scene,
                                          int min_shared_tracks = 30);

/// Few inliers, chance, or a large deviation, as the options say; or most
/// candidates of every kind contradict it.
bool IsWeak(const ScaleRatio& ratio, const DiagnosisOptions& options);

}  // namespace lowlap
