#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The worlds that can be simulated; all are metric (metres), and all but the
/// cloud are made of walls that carry points and lines.
enum class SyntheticKind {
  kRoom,      // a crooked box of 6 x 4.5 x 2.7 m, cameras on a loop inside it
  kCorridor,  // walls in sections; cameras walk along it and turn
  kRing,      // cameras on a circle look at boxes in its middle
  kHouse,  // cameras walk around a house of 8 x 6 x 4 m, without surroundings
  kCloud,  // the room without walls: all is strewn over the space before them
  // Degenerate worlds:
  kPlanar,        // one wall and nothing else
  kCollinear,     // the room, with all centres on one straight line
  kPureRotation,  // the room, with views 0 and 1 at one centre
  kTwins,         // the room, every odd view next to the one before it
};

/// "room", "corridor", "ring", "house", "cloud", "planar", "collinear",
/// "pure_rotation", "twins".
const char* SyntheticKindName(SyntheticKind kind);
std::optional<SyntheticKind> SyntheticKindFromName(const std::string& name);

struct SyntheticOptions {
  SyntheticKind kind = SyntheticKind::kRoom;
  /// Views of a room, ring or house are spread over its loop, but at most 30
  /// degrees apart: with less than 12 the loop stays open.
  int num_views = 12;
  /// Pairs of views with a relative pose: "chain", "cycle", "window:N" (at most
  /// N views apart), "loop:N" (the same, and the last views are next to the
  /// first), or "all" (whatever shares at least 16 features). A pair
  /// without a single match is left out, unless points_per_wall and
  /// lines_per_wall are both 0: then only the graph of poses is of interest.
  std::string pairs = "cycle";
  /// kRoom, kCloud, kPureRotation and kTwins: a small loop, looking outwards,
  /// instead of a wide one, looking across. Neighbours then share less, and
  /// turn more than they move.
  bool look_outwards = false;
  /// kCollinear: how far the centres are off their line, as the standard
  /// deviation of the two coordinates across it, in metres.
  double off_line_m = 0.0;
  /// kTwins: distance of an odd view from the one before it, in metres.
  double twin_baseline_m = 0.0;
  /// kCorridor: length of a section of its walls, in metres.
  double section_m = 5.0;
  /// kHouse: the part of every side, from its left end, that looks the same as
  /// that of the opposite side. kCorridor: the part of every section that looks
  /// the same as that of the others, floor and ceiling included, as doors and
  /// lamps do; the corridor is straight then.
  double alike_share = 0.0;

  /// How far the middle of every wall bows out: part of a cylinder, whose only
  /// lines are its rulings (upright ones on upright walls).
  double wall_bulge_m = 0.0;
  /// How far the front of a box, in the middle of every wall, is before it.
  double box_offset_m = 0.0;
  int points_per_wall = 100;
  int lines_per_wall = 160;
  /// Share of the points (lines) that may be seen by three views or more. The
  /// others are seen by the two views of one pair, drawn at random from those
  /// they fit: at 0 no two pairs share a feature, but their lines mix on the
  /// same walls.
  double trifocal_point_share = 1.0;
  double trifocal_line_share = 1.0;

  /// Standard deviation of each coordinate of a point, and of a segment's end.
  double noise_px = 0.0;
  /// Share of the observed lines that fall into two segments, view by view.
  double broken_line_share = 0.0;
  /// Share of the tracks that are wrong: from view to view the match is
  /// another point (line).
  double wrong_point_share = 0.0;
  double wrong_line_share = 0.0;
  /// Wrong matches obey the epipolar geometry of their pair, as they do when
  /// they come through a robust two-view step: a wrong depth. Otherwise they
  /// are anywhere in the image.
  bool wrong_fits_epipolar = true;
  /// Share of the candidate pairs of CountCoplanarCandidates, over all
  /// triplets, that are not coplanar. Lines are moved off their walls, towards
  /// the cameras, until the share is reached; a world whose share is already
  /// higher (neighbouring walls) stays as it is. 0: no line is moved.
  double wrong_candidate_share = 0.0;

  /// Errors of the relative poses, normal about each axis: 3 of the rotation,
  /// 2 across the direction.
  double rotation_noise_deg = 0.0;
  double direction_noise_deg = 0.0;
  /// Besides, errors as of a relative pose estimated from the right point
  /// matches with noise_px: normal, with this many times the deviations of that
  /// estimate to first order (RelativePose::covariance), and at most 0.3 rad.
  double pose_noise_factor = 0.0;
  /// Share of the relative poses whose direction is any direction, and which
  /// state the evidence (log10_nfa) that their matches give the right one.
  double wrong_direction_share = 0.0;
  /// Share of those that are any rotation and any direction, likewise.
  double wrong_pose_share = 0.0;

  int width_px = 1200;
  int height_px = 900;
  double focal_px = 900.0;
  std::uint64_t seed = 0;

  /// kInvalidArgument with the option's name and what it may be.
  Status Validate() const;
};

/// The truth about a line track.
struct SyntheticLine {
  Vec3 start = Vec3::Zero();  // in world
  Vec3 end = Vec3::Zero();
  /// Walls the line lies on: none (off the walls), one, or two (an edge).
  std::vector<int> planes;
};

/// Tracks of two places that look the same.
template <class Id>
struct AlikeTracks {
  Id first;
  Id second;
  /// Carries what is around the second place to what is around the first.
  Mat3 first_from_second = Mat3::Identity();
};

/// What a scene file would hold after the two-view step (views, intrinsics,
/// features, relative poses, tracks; nothing solved), and the truth beside it.
struct SyntheticScene {
  Scene scene;
  std::map<ViewId, Pose> true_poses;
  /// Distance of the two centres, lambda of the relative pose. 0 for a pure
  /// rotation, whose stored direction is arbitrary.
  std::map<ViewPair, double> true_baselines;
  /// By track; a wrong track has no entry.
  std::map<PointTrackId, Vec3> true_points;
  std::map<LineTrackId, SyntheticLine> true_lines;
  /// What looks the same (alike_share), and no match joins: of the places of
  /// one look the first track with each of the others.
  std::vector<AlikeTracks<PointTrackId>> alike_points;
  std::vector<AlikeTracks<LineTrackId>> alike_lines;
  /// n . X + d = 0 with |n| = 1, by plane id.
  std::vector<Vec4> planes;

  /// log( lambda(middle, last) / lambda(first, middle) ); nullopt if one of the
  /// two is not a pair of the scene, or has no baseline.
  std::optional<double> TrueLogRatio(const ViewTriplet& triplet) const;
};

/// Simulates a scene. The same options give the same scene on every machine.
/// Errors: those of Validate().
Result<SyntheticScene> Simulate(const SyntheticOptions& options);

/// The scene with the truth filled in as its solution: poses, scale ratios
/// (without support), structure and line structure, with all observations of
/// the right tracks.
Scene TrueSolution(const SyntheticScene& synthetic);

}  // namespace lowlap
