#pragma once

#include <cstddef>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// How tracks become landmarks.
struct StructureOptions {
  bool use_points = true;
  bool use_lines = true;
  bool use_coplanar = true;  // needs use_lines

  /// Largest error of an observation, in pixels. 0: a contrario, from the
  /// residuals of all tracks of the kind, and at least the thresholds that the
  /// relative poses were verified with. Change it only for data whose noise is
  /// known better than its residuals tell.
  double max_point_error_px = 0;
  double max_line_error_px = 0;

  /// A point is kept if the standard deviation of its depth, propagated
  /// from the image noise, is at most this share of the depth. It takes the
  /// place of a least triangulation angle: it knows the focal length, the
  /// noise and the number of views.
  double max_relative_depth_stddev = 0.3;
  /// The same for lines, at the worse end of their extent. Lines near an
  /// epipolar plane say little and make the adjustment slow.
  double max_relative_line_depth_stddev = 0.1;

  /// A line seen in two views fits them always. It is kept if its segments,
  /// lifted onto it, share at least this part of the shorter one.
  double min_two_view_line_overlap = 0.2;

  /// Lines of a coplanar pair must differ by this angle: the meeting point of
  /// almost parallel lines is not defined by the images.
  double min_coplanar_angle_deg = 10;

  /// kInvalidArgument for values without a meaning.
  Status Validate() const;
};

/// What became of the tracks of one kind. Every track is counted once, in
/// `landmarks` or in one of the reasons after it.
struct TriangulationSummary {
  std::size_t tracks = 0;
  std::size_t landmarks = 0;
  std::size_t two_view_landmarks = 0;  // of `landmarks`
  std::size_t too_few_views = 0;       // fewer than two with pose and intrinsic
  std::size_t inconsistent = 0;        // no two observations that agree
  std::size_t behind_camera = 0;
  std::size_t uncertain = 0;    // depth not determined, see the options
  std::size_t implausible = 0;  // lines: segments that do not overlap

  std::size_t observations = 0;          // of all tracks, in usable views
  std::size_t observations_used = 0;     // of the landmarks
  std::size_t observations_dropped = 0;  // of landmarks, beyond the threshold
  double threshold_px = 0;
};

struct StructureSummary {
  TriangulationSummary points;
  TriangulationSummary lines;
  /// Coplanar inliers of the meaningful ratios, and why some are not pairs.
  std::size_t coplanar_inliers = 0;
  std::size_t coplanar_without_lines = 0;  // a line was not triangulated
  std::size_t coplanar_parallel = 0;       // or both are one line
  std::size_t coplanar_duplicates = 0;     // already a pair
  std::size_t coplanar_pairs = 0;
  double seconds = 0;
};

/// Triangulates scene->point_tracks and scene->line_tracks from scene->poses,
/// and collects the coplanar pairs of scene->scale_ratios: replaces
/// `structure`, `line_structure` and `coplanar_pairs` of the enabled kinds
/// (clears those of the others).
///
/// Points: the pair of observations that most others agree with is refined on
/// all that agree (reprojection error below the threshold, in front of every
/// camera); tracks of two views are landmarks like the others. Lines: the same
/// with interpretation planes and the distances of the segments' end points;
/// the extent is what the segments cover.
///
/// Observations in views without a pose or an intrinsic are left out. The
/// result does not depend on the number of threads. Errors: kInvalidArgument
/// (options, null scene), kInvalidScene (a track refers to a missing feature, a
/// number that is not finite), kCancelled.
Result<StructureSummary> BuildStructure(Scene* scene,
                                        const StructureOptions& options,
                                        const RunContext& context);

}  // namespace lowlap
