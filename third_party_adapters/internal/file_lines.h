#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A segment of an image that supports a line, by its number in that image.
struct SupportingSegment {
  ViewId view = kInvalidId;
  std::uint32_t number = 0;
  Vec2 start_px = Vec2::Zero();
  Vec2 end_px = Vec2::Zero();
};

/// A triangulated line as LIMAP's and Line3D++'s files have it.
struct FileLine {
  Vec3 start = Vec3::Zero();  // in world
  Vec3 end = Vec3::Zero();
  std::vector<SupportingSegment> support;
};

/// Adds lines to the structure and the line tracks of a scene; ids are places
/// in the list. Views that the scene does not have are added, without anything.
///
/// Where a view has segments, the numbers are their indices (kInvalidScene for
/// one beyond them). Otherwise the segments that support lines become those of
/// the view, in the order of their numbers; `notes` says where that changes
/// them. Lines that fewer than two segments support are left out and noted.
Status AddFileLines(const std::vector<FileLine>& lines, Scene* scene,
                    SceneNotes* notes);

/// The lines of a scene, in the order of their ids; tracks without a line are
/// noted.
std::vector<FileLine> FileLinesOf(const Scene& scene, SceneNotes* notes);

/// "x1 y1 x2 y2".
std::string SegmentText(const Vec2& start_px, const Vec2& end_px);

/// A scene as of undistorted photographs: intrinsics with distortion become
/// pinholes with the same focal lengths and principal point, and key points,
/// segments and observations move; what cannot be undistorted stays where it
/// is. Both are noted. kUnsupported for panoramas.
Result<Scene> UndistortedScene(const Scene& scene, SceneNotes* notes);

}  // namespace lowlap
