#pragma once

#include <type_traits>
#include <vector>

#include "lowlap/adjustment/internal/costs/relative_pose_prior.h"
#include "lowlap/adjustment/internal/costs/scale_ratio_prior.h"
#include "lowlap/adjustment/internal/directions/scene_directions.h"
#include "lowlap/adjustment/internal/structure/line_track.h"
#include "lowlap/adjustment/internal/structure/noise_scale.h"
#include "lowlap/adjustment/internal/structure/point_track.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

struct PairState {
  int first = -1;  // indices into StructureState::lines
  int second = -1;
  bool used = false;       // has residuals
  bool consistent = true;  // believed, whether in use or not
  int times_dropped = 0;
};

/// A landmark that a plane holds.
struct PlaneTie {
  int landmark = -1;     // index into StructureState::points or lines
  double looseness = 1;  // what it may be off, in thicknesses of the plane
};

/// A plane of the scene, normal . (x - anchor) = offset, and the landmarks that
/// are tied to it, or to what it bows to.
struct PlaneState {
  Vec3 normal = Vec3::UnitZ();  // unit
  Vec3 anchor = Vec3::Zero();
  double offset = 0;
  double thickness = 0;  // standard deviation of what is on it, world units
  /// The wall is off the plane by a^T bend a along the normal, a = x - anchor.
  Mat3 bend = Mat3::Zero();
  double log10_nfa = 0;
  std::vector<PlaneTie> points;
  std::vector<PlaneTie> lines;
};

/// All tracks and landmarks of a scene, in the form in which they are worked
/// on. Tracks keep every candidate, whether in use or not.
struct StructureState {
  std::vector<PointTrackState> points;  // by id
  std::vector<LineTrackState> lines;    // by id
  std::vector<PairState> pairs;
  std::vector<PlaneState> planes;
  std::vector<RelativePosePrior> priors;
  std::vector<ScaleRatioPrior> ratio_priors;
  std::vector<SceneDirection> directions;

  /// Whether both lines of the pair are landmarks.
  bool HasLines(const PairState& pair) const {
    return lines[pair.first].IsLandmark() && lines[pair.second].IsLandmark();
  }
};

struct NoiseLevels {
  NoiseScale points;
  NoiseScale lines;
  NoiseScale coplanar;
};

/// Candidates from scene.point_tracks, joined with the observations that
/// scene.structure holds already; those observations are in use and the
/// landmarks are taken over. A landmark without a track brings its own
/// observations. The scene must be valid (ValidateScene).
std::vector<PointTrackState> LoadPoints(const Scene& scene,
                                        const CameraSet& cameras);

/// The same for lines. `with_intrinsic_derivatives` where intrinsics will be
/// refined. Segments that cannot be undistorted are left out.
std::vector<LineTrackState> LoadLines(const Scene& scene,
                                      const CameraSet& cameras,
                                      bool with_intrinsic_derivatives);

/// scene.coplanar_pairs whose lines are both landmarks, none in use.
std::vector<PairState> LoadPairs(const Scene& scene,
                                 const std::vector<LineTrackState>& lines);

/// The rays of all lines' segments from the present intrinsics, with their
/// derivatives.
void RefreshRays(const Scene& scene, const CameraSet& cameras,
                 StructureState* state);

/// Of the observations in use, whether most are of landmarks that two views
/// see.
bool MostAreSeenTwice(const StructureState& state);

Landmark ToLandmark(const CameraSet& cameras, const PointTrackState& track);
LineLandmark ToLandmark(const CameraSet& cameras, const LineTrackState& track);

/// Noise of a kind from the errors of all candidates of all landmarks, scaled
/// up by sqrt(m / (m - f)), m the measurements in use and f the unknowns of the
/// landmark: what they would be if the landmark had not been fitted to them.
/// Landmarks without redundancy say nothing and are left out.
NoiseScale EstimateNoise(const CameraSet& cameras,
                         const std::vector<PointTrackState>& points,
                         const NoiseBounds& bounds);
NoiseScale EstimateNoise(const CameraSet& cameras,
                         const std::vector<LineTrackState>& lines,
                         const NoiseBounds& bounds);

/// The limits of a kind by StructureOptions or AdjustmentOptions.
template <class Track, class Options>
TriangulationLimits LimitsOf(const Options& options, const NoiseScale& noise) {
  return {noise.threshold_px, noise.stddev_px,
          std::is_same_v<Track, LineTrackState>
              ? options.max_relative_line_depth_stddev
              : options.max_relative_depth_stddev,
          options.min_two_view_line_overlap};
}

/// Triangulates all tracks but those marked in `left_out`, on the context's
/// threads.
template <class Track>
Status TriangulateAll(const CameraSet& cameras,
                      const TriangulationLimits& limits,
                      const RunContext& context, std::vector<Track>* tracks,
                      const std::vector<char>& left_out = {}) {
  return ParallelFor(context, {}, tracks->size(), [&](std::size_t n) {
    if (left_out.empty() || !left_out[n]) {
      Triangulate(cameras, limits, &(*tracks)[n]);
    }
  });
}

}  // namespace lowlap
