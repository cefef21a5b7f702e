#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/similarity.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// True poses by view id: the form in which every evaluation takes them. The
/// world frame, its unit and its scale are the truth's own.
using GroundTruth = std::map<ViewId, Pose>;

/// Assigns true poses to the views of a scene by image name: the path below the
/// image folder if it matches, else the file name, else the file name without
/// extension (which starts with a letter). If that matches no view at all,
/// truths go by their file names, too, whatever their folders. A name that two
/// truths share decides nothing. Views without truth are left out.
///
/// Errors: kInvalidScene if a name fits two views equally well;
/// kInsufficientData if no view has a truth.
Result<GroundTruth> GroundTruthByName(
    const Scene& scene, const std::map<std::string, Pose>& pose_by_image);

/// The poses of a scene (a simulated one, a reference solution) as truth.
GroundTruth GroundTruthFromScene(const Scene& truth);

/// The same for the views of another scene: by image name (GroundTruthByName).
/// Where two of its posed views share one, as those without names, or where no
/// name matches and all are but ids, as timestamps may be, it goes by view id,
/// or by the number that each file name ends in if that finds more views:
/// COLMAP counts from one, and a list of poses from zero.
///
/// Errors: those of GroundTruthByName; kInvalidScene where ids and numbers find
/// as many views, but different ones.
Result<GroundTruth> GroundTruthFromScene(const Scene& truth,
                                         const Scene& scene);

/// Summary of non-negative errors; all zero for none.
struct ErrorStatistics {
  int count = 0;
  double mean = 0;
  double median = 0;  // mean of the middle two of an even number
  double max = 0;
  double rmse = 0;

  /// For nlohmann::json.
  template <class Json>
  friend void to_json(Json& json, const ErrorStatistics& errors) {
    json = {{"count", errors.count},
            {"mean", errors.mean},
            {"median", errors.median},
            {"max", errors.max},
            {"rmse", errors.rmse}};
  }
};

ErrorStatistics Summarize(std::vector<double> errors);

struct ViewPoseError {
  ViewId view = kInvalidId;
  std::string name;           // the path below the image folder
  double position_error = 0;  // in the truth's unit
  double rotation_error_deg = 0;
};

/// What the cameras common to solution and truth allow to say.
enum class EvaluationScope {
  kNothing,        // fewer than 2 cameras
  kRotationsOnly,  // 2 cameras, or all in one place: a similarity fits exactly
  kFull,           // 3 and more
};

/// "nothing", "rotations_only", "full".
const char* EvaluationScopeName(EvaluationScope scope);

/// Poses of a solution against the truth. A solution is known up to a
/// similarity, which is removed first:
/// - positions: the similarity truth_from_solution that minimises the squared
///   distances of the centres (AlignPoints), error |C_true - S C|;
/// - rotations: the world rotation Q that minimises sum |R_true Q - R|_F^2 over
///   the cameras, error = angle of R^T R_true Q. It comes from the rotations
///   themselves, since centres on a line leave the turn about it open;
///   `frame_disagreement_deg` is its angle to the rotation of the similarity.
struct PoseEvaluation {
  EvaluationScope scope = EvaluationScope::kNothing;
  std::string note;    // why the scope is not kFull; else empty
  int num_total = 0;   // views of the scene that have a true pose
  int num_solved = 0;  // of these, with a solved pose
  std::vector<std::string> unsolved;  // names of the others
  /// Names of the solved views that have no true pose: nothing tells their
  /// errors.
  std::vector<std::string> without_truth;
  Similarity truth_from_solution;     // identity unless kFull
  double frame_disagreement_deg = 0;  // 0 unless kFull
  std::vector<ViewPoseError> views;   // the solved ones, by view id
  ErrorStatistics position;           // empty unless kFull
  ErrorStatistics rotation_deg;       // empty if kNothing
};

PoseEvaluation EvaluatePoses(const Scene& scene, const GroundTruth& truth);
/// The same for other poses than the scene's.
PoseEvaluation EvaluatePoses(const std::map<ViewId, View>& views,
                             const std::map<PoseId, Pose>& poses,
                             const GroundTruth& truth);

/// A table for people: one line per view, then the summary.
std::string ToText(const PoseEvaluation& evaluation);
/// A JSON object with the members' names (sizes and errors, no rotation data).
std::string ToJson(const PoseEvaluation& evaluation);

}  // namespace lowlap
