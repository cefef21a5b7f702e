#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A true edge of a rendered scene: a polyline, since real edges are not quite
/// straight.
struct TrueEdge {
  std::string name;
  std::vector<Vec3> points_in_world;
  /// Numbers of the images that show it, of a visible length worth a match.
  std::set<int> images;
};

/// Reads a list of true edges, JSON:
///   {"edges": [{"name": ..., "p0": [x, y, z], "p1": [x, y, z],
///               "pts": [[x, y, z], ...],
///               "views": [[image, visible fraction, visible length], ...]}]}
/// `pts` (optional) is the polyline, else it is p0, p1. `image` is the number
/// that the image's file name is. Errors: those of ReadWholeFile, kParse.
Result<std::vector<TrueEdge>> ReadTrueEdges(const std::string& path);

/// The number that a view's file name without extension is ("0012.jpg": 12).
std::optional<int> ImageNumber(const View& view);

/// When a detected segment lies on a true edge: a piece of the projected
/// polyline is at most `max_angle_deg` from the segment's direction and
/// `max_distance_px` from its midpoint, and shares at least `min_overlap` of
/// the shorter of the two.
struct EdgeAssignmentRule {
  double max_angle_deg = 2.5;
  double max_distance_px = 2.5;
  double min_overlap = 0.5;
};

/// For every segment of the view, the indices of the edges on which it lies,
/// among those that the image shows. `pose`: the view's true pose.
std::vector<std::set<std::size_t>> AssignEdges(
    const std::vector<LineSegment>& segments,
    const std::vector<TrueEdge>& edges, int image, const Pose& pose,
    const Intrinsic& intrinsic, const EdgeAssignmentRule& rule);

}  // namespace lowlap
