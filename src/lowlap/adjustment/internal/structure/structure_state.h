#pragma once

#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/adjustment/internal/costs/relative_pose_prior.h"
#include "lowlap/adjustment/internal/structure/line_track.h"
#include "lowlap/adjustment/internal/structure/noise_scale.h"
#include "lowlap/adjustment/internal/structure/point_track.h"
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

/// All tracks and landmarks of a scene, in the form in which they are worked
/// on. Tracks keep every candidate, whether in use or not.
struct StructureState {
  std::vector<PointTrackState> points;  // by id
  std::vector<LineTrackState> lines;    // by id
  std::vector<PairState> pairs;
  std::vector<RelativePosePrior> priors;
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

Landmark ToLandmark(const CameraSet& cameras, const PointTrackState& track);
LineLandmark ToLandmark(const CameraSet& cameras, const LineTrackState& track);

/// Errors of all candidates of all landmarks, scaled up by sqrt(m / (m - f)),
/// m the measurements in use and f the unknowns of the landmark: what they
/// would be if the landmark had not been fitted to them. Landmarks without
/// redundancy say nothing and are left out.
std::vector<double> PointErrorsPx(const CameraSet& cameras,
                                  const std::vector<PointTrackState>& points);
std::vector<double> LineErrorsPx(const CameraSet& cameras,
                                 const std::vector<LineTrackState>& lines);

/// Noise of the two kinds from these errors.
NoiseScale EstimatePointNoise(const CameraSet& cameras,
                              const std::vector<PointTrackState>& points,
                              const NoiseBounds& bounds);
NoiseScale EstimateLineNoise(const CameraSet& cameras,
                             const std::vector<LineTrackState>& lines,
                             const NoiseBounds& bounds);

/// The indices of so many tracks.
std::vector<std::size_t> AllOf(std::size_t count);

/// Triangulates the tracks with the given indices, on the context's threads.
Status TriangulatePoints(const CameraSet& cameras,
                         const PointTriangulationLimits& limits,
                         const RunContext& context,
                         const std::vector<std::size_t>& which,
                         std::vector<PointTrackState>* points);
Status TriangulateLines(const CameraSet& cameras,
                        const LineTriangulationLimits& limits,
                        const RunContext& context,
                        const std::vector<std::size_t>& which,
                        std::vector<LineTrackState>* lines);

}  // namespace lowlap
