#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/intrinsic.h"
#include "lowlap/scene/relative_pose.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/tracks.h"
#include "lowlap/scene/view.h"

namespace lowlap {

/// Two lines of `line_structure` that lie in one plane, first < second.
struct CoplanarPair {
  LineTrackId first = kInvalidId;
  LineTrackId second = kInvalidId;

  friend bool operator==(const CoplanarPair& a, const CoplanarPair& b) {
    return a.first == b.first && a.second == b.second;
  }
  friend bool operator<(const CoplanarPair& a, const CoplanarPair& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  }
};

/// The one thing that passes between the stages: what is measured (views,
/// intrinsics, features, relative poses, tracks) and what is solved (ratios,
/// poses, structure). sfm_data/FORMAT.md describes the file form of every
/// member. Maps are ordered by id, so that every pass over a scene, and every
/// file written from it, has one order.
struct Scene {
  // Compiled once, since copies of maps are long code.
  Scene();
  ~Scene();
  Scene(const Scene& other);
  Scene& operator=(const Scene& other);
  Scene(Scene&& other) noexcept;
  Scene& operator=(Scene&& other) noexcept;

  std::string root_path;  // image folder; relative: to where the program runs
  std::map<ViewId, View> views;
  std::map<IntrinsicId, Intrinsic> intrinsics;
  /// Of the intrinsics that an adjustment moved: as they were before, with
  /// which the relative poses were measured.
  std::map<IntrinsicId, Intrinsic> given_intrinsics;
  std::map<PoseId, Pose> poses;  // only solved poses

  std::map<ViewId, ViewFeatures> features;
  std::map<ViewPair, RelativePose> relative_poses;  // first < second
  /// Ascending, first < second: pairs that were compared in vain. No motion is
  /// meaningful, or what repeats within the photographs alone bears one out.
  /// Those that differ by a rotation only, or whose relative pose was dropped,
  /// are none: things are seen in both.
  std::vector<ViewPair> unrelated_pairs;
  std::map<PointTrackId, Track> point_tracks;
  std::map<LineTrackId, Track> line_tracks;

  std::vector<ScaleRatio> scale_ratios;
  /// Keys are those of point_tracks where a landmark came from one.
  std::map<PointTrackId, Landmark> structure;
  std::map<LineTrackId, LineLandmark> line_structure;
  std::vector<CoplanarPair> coplanar_pairs;
  std::map<std::uint32_t, Landmark> control_points;

  /// The view's intrinsic; nullptr if it has none.
  const Intrinsic* FindIntrinsic(ViewId view) const;
  /// The view's solved pose; nullptr if it has none.
  const Pose* FindPose(ViewId view) const;
  const RelativePose* FindRelativePose(ViewId a, ViewId b) const;
  /// root_path / local_path / filename.
  std::string ImagePath(ViewId view) const;
  /// What people call a view: View::PathBelowRoot; its id if the scene has no
  /// such view, or the view no file name.
  std::string NameOf(ViewId view) const;

  friend bool operator==(const Scene& a, const Scene& b);
};

/// A copy without the named views and everything that refers to them (tracks
/// and landmarks shrink, those left with one view go). Unknown ids are ignored.
Scene WithoutViews(const Scene& scene, const std::vector<ViewId>& excluded);

}  // namespace lowlap
