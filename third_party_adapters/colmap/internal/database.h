#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"

namespace lowlap::colmap {

/// Whether the first bytes of a file are those of an SQLite database.
bool IsDatabaseStart(std::string_view start);
/// The same of a file; false for one that cannot be read.
bool IsDatabase(const std::string& path);

/// What a database of COLMAP holds, of any version.
struct Database {
  /// Views, intrinsics, the keypoints as the points of the views, and, as
  /// unrelated, the pairs with a row that holds no match. Ids are those of the
  /// database.
  Scene scene;
  /// Of every pair that has any, first < second: the matches that COLMAP's
  /// verification kept (two_view_geometries), or those before it (matches)
  /// where it kept none. Pairs that it took for watermarks have none.
  std::map<ViewPair, std::vector<FeatureMatch>> matches;
  /// Those that are stored, with their inliers: COLMAP stores none as a rule.
  std::map<ViewPair, RelativePose> relative_poses;
  SceneNotes notes;
};

/// Reads a database without changing it; columns are found by name. Errors,
/// with table and row: kParse (not a database, damaged, blobs of the wrong
/// size), kInvalidScene (a table that is missing, indices beyond the keypoints,
/// ...), kUnsupported (ToIntrinsic).
Result<Database> ReadDatabase(const std::string& path);

/// The same as a scene: matches without a stored relative pose are left out,
/// and noted; tracks are made of the others.
Result<Scene> ReadDatabaseScene(const std::string& path, SceneNotes* notes);

/// Whether there is a database to write into: kNotFound, kParse otherwise.
Status CheckDatabaseToUpdate(const std::string& path);

/// Makes the relative poses of a scene and their inliers the two-view
/// geometries of its views in an existing database; views are found by the
/// names of their images. One transaction, all or nothing. Returns notes.
///
/// Errors: those of CheckDatabaseToUpdate, kInvalidArgument (an image that the
/// database does not have, or other keypoints than the scene's points), and as
/// above.
Result<SceneNotes> WriteRelativePoses(const Scene& scene,
                                      const std::string& path);

}  // namespace lowlap::colmap
