#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Rotations and directions of relative poses are never better than this,
/// whatever a covariance says: matches share systematic errors (calibration,
/// texture) that it does not know.
inline constexpr double kPoseErrorFloorRad = 5e-4;
/// Nor are log ratios, for the same reason.
inline constexpr double kRatioErrorFloor = 1e-3;

/// Standard deviation of the direction about each axis across it, in radians:
/// as stated, with the floor; a default if unknown.
double DirectionStddev(const RelativePose& pose);

/// A measured direction between two camera centres, with unknown length:
///   C_second - C_first = length direction_in_world,  length > 0.
struct DirectionEdge {
  std::size_t first = 0;  // indices into TranslationProblem::views
  std::size_t second = 0;
  Vec3 direction_in_world = Vec3::UnitX();
  double stddev_rad = 0.01;
};

/// A measured ratio of two edge lengths:
///   log length(target) - log length(reference) = log_ratio.
struct RatioMeasurement {
  ViewTriplet views;  // reference: (first, middle), target: (middle, last)
  std::size_t reference = 0;  // indices into TranslationProblem::edges
  std::size_t target = 0;
  double log_ratio = 0;
  double stddev = 0.05;
  double log10_nfa = 0;
};

/// One observation of a point: X - C_view = depth ray_in_world, depth > 0.
struct RayObservation {
  std::size_t view = 0;  // index into TranslationProblem::views
  Vec3 ray_in_world = Vec3::UnitZ();
};

/// The rays of one point track, at most one per view.
struct TrackRays {
  std::vector<RayObservation> observations;
};

/// What every averaging strategy gets; what it does not need it ignores.
struct TranslationProblem {
  std::vector<ViewId> views;
  std::vector<Mat3> cam_from_world;  // rotations, one per view
  std::vector<DirectionEdge> edges;
  std::vector<RatioMeasurement> ratios;
  /// Filled only for strategies that ask for it (NeedsTracks).
  std::vector<TrackRays> tracks;
};

/// Centres up to one similarity (scale and translation) per component.
struct TranslationSolution {
  /// Per view: its component, or -1 if the strategy cannot place it. Component
  /// 0 has the most views; components do not share a scale.
  std::vector<int> component;
  std::vector<Vec3> center_in_world;
  int num_components = 0;
  int num_iterations = 0;

  /// Views in component 0.
  int NumPlaced() const;
};

/// A translation averaging strategy.
class TranslationAverager {
 public:
  virtual ~TranslationAverager() = default;
  virtual std::string Name() const = 0;
  /// Whether Solve looks at TranslationProblem::tracks.
  virtual bool NeedsTracks() const { return false; }
  /// What a view needs to be placed with the others, for people: completes the
  /// sentence "a view needs ...".
  virtual std::string Needs() const {
    return "directions that fix its place among the others without any length "
           "(cycles that share no single camera); scale ratios are not used";
  }
  /// Centres of what the strategy can place; views that it cannot are no error
  /// but have component -1. Errors: those of ValidateProblem; kNumerical if an
  /// equation or a program cannot be solved; kUnsupported for a problem too
  /// large for the strategy; kCancelled.
  virtual Result<TranslationSolution> Solve(
      const TranslationProblem& problem, const RunContext& context) const = 0;
};

/// The problem of a scene whose rotations are known: every relative pose whose
/// two views are in `cam_from_world` gives an edge, every meaningful scale
/// ratio between such edges a ratio. Scale ratios and edges named in
/// `excluded_edges` are left out. Ratios of the triplets in `weak` take part
/// though they are not meaningful, with a deviation of at least 0.2.
/// `with_tracks`: the rays of the point tracks too (MakeTrackRays).
TranslationProblem MakeTranslationProblem(
    const Scene& scene, const std::map<ViewId, Mat3>& cam_from_world,
    const std::vector<ViewPair>& excluded_edges,
    const std::set<ViewTriplet>& weak = {}, bool with_tracks = false);

/// Indices in range, numbers finite, deviations positive; else
/// kInvalidArgument.
Status ValidateProblem(const TranslationProblem& problem);

}  // namespace lowlap
