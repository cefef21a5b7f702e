#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap::onedsfm {

// The problem folders of Wilson, Snavely, "Robust global translations with
// 1DSfM", ECCV 2014: photo collections from the web, as view graphs.
//
//   EGs.txt     i j R(9) t(3): relative poses. Needed; the rest is optional.
//   cc.txt      the images to use; without it, those that EGs.txt names
//   list.txt    a name per image, perhaps with a focal length: `name 0 focal`
//   coords.txt  per image its size, focal length and keypoints
//   tracks.txt  points, as (image, keypoint) pairs
//   gt_bundle.out  reference cameras (Bundler)
//
// The files' cameras look along -z with y up. With D = diag(1, -1, -1),
//   R_ij = R_i R_j^T,  t_ij = R_i (C_j - C_i) / |C_j - C_i|
// becomes the relative pose (i, j) of lowlap, x_j = R x_i + lambda t:
//   R = D R_ij^T D,  t = -R D t_ij.

/// Whether the path is a folder with an EGs.txt.
bool IsProblemFolder(const std::string& path);

struct Problem {
  /// View ids are the image indices. Views without a known focal length have no
  /// intrinsic: the file holds neither distortion nor aspect ratio, so that
  /// intrinsics are pinholes with the principal point in the middle of the
  /// image; scale ratios need intrinsics, strategies on directions do not.
  /// Pixels
  /// are one less than in coords.txt, which calls the centre of
  /// the first pixel (1, 1). The point inliers of a relative pose are what the
  /// tracks match in it; nobody has compared them with the pose. No poses.
  Scene scene;
  /// One sentence for each kind of thing that was left out.
  std::vector<std::string> notes;
};

/// Errors, each with file and line: kNotFound without EGs.txt; kParse for text
/// that is malformed, not UTF-8, or ends early, and for matrices that are no
/// rotations (to 1e-3); kInvalidScene for images or keypoints that do not
/// exist. Left out with a note: relative poses and track observations of images
/// that are not used, relative poses listed again, tracks that see an image
/// twice (in that image), tracks without coords.txt.
Result<Problem> ReadProblem(const std::string& folder);

/// Views with the reference cameras of gt_bundle.out, by image index, in the
/// frame and unit of the file: camera-from-world rotation D R, centre -R^T t;
/// with the names of list.txt, if it is there. Cameras that the file leaves
/// empty are left out. kNotFound without gt_bundle.out; kInvalidScene if it has
/// more cameras than list.txt names.
Result<Scene> ReadTrueCameras(const std::string& folder);

}  // namespace lowlap::onedsfm
