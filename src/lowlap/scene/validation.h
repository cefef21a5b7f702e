#pragma once

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Checks that a scene does not contradict itself, in time linear in its size
/// (times the logarithm of the number of views):
/// - every id refers to something: a view's intrinsic (unless kInvalidId), the
///   views, features and segments of relative poses, tracks, landmarks and
///   ratios, the views of unrelated pairs, the relative poses of
///   a ratio, the lines of a coplanar pair; every intrinsic and pose is used by
///   a view (OpenMVG refuses a file otherwise);
/// - numbers are finite, rotations are rotations and directions are unit (to
///   1e-6), Pluecker moments are orthogonal to their directions;
/// - pairs are ordered (first < second) and nothing is listed twice;
/// - tracks and landmarks have at least two observations, sorted by view, none
///   repeated, and points at most one per view;
/// - strings are UTF-8, as the text form needs them.
///
/// A landmark's observation may be of a view without pose or intrinsic: partial
/// exports of OpenMVG hold such, and they are what a view is resected from.
/// Its feature index is checked only where the scene has points of that view;
/// that of a control point, which means nothing, is not.
///
/// The first violation comes back as kInvalidScene whose `place` is the path of
/// the offending value in the JSON form of the scene, e.g.
/// `$.views[key=3].id_intrinsic`; sfm_data/FORMAT.md explains the notation.
Status ValidateScene(const Scene& scene);

/// The part of it that concerns the rotations, directions, evidence and
/// covariances of one relative pose and its alternatives.
Status ValidateRelativePose(const RelativePose& pose);

}  // namespace lowlap
