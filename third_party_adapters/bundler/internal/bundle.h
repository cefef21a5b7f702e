#pragma once

#include <map>
#include <string>
#include <string_view>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/scene/view.h"
#include "third_party_adapters/bundler/internal/centered_model.h"

namespace lowlap::bundler {

// Bundler's output, bundle.out v0.3 (or without its first line):
//
//   number of cameras, number of points
//   per camera: f k1 k2, R (3 x 3), t (3); all 0 for one that is not solved
//   per point:  X, colour, number of observations,
//               each as camera, key, x, y
//
// Cameras look along -z with y up. With D = diag(1, -1, -1),
//   P = R X + t,  p = -(P.x, P.y) / P.z,  (x, y) = f (1 + k1 p^2 + k2 p^4) p,
// so that our rotation is D R, the centre -R^T t, and y points up from the
// principal point.

/// Errors: kParse with file and line for text that is malformed, ends early or
/// names a camera that is not there.
Result<CenteredModel> ParseBundle(std::string_view text,
                                  const std::string& file);

/// The cameras alone, by index; points are not looked at.
Result<std::map<ViewId, Pose>> ParseBundlePoses(std::string_view text,
                                                const std::string& file);

std::string FormatBundle(const CenteredModel& model);

/// The pose of Bundler's R and t, and back.
Pose PoseFromBundle(const Mat3& rotation, const Vec3& translation);
RigidTransform BundleFromPose(const Pose& pose);

}  // namespace lowlap::bundler
