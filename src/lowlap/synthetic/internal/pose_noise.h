#pragma once

#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// Adds the errors of SyntheticOptions::pose_noise_factor, and their
/// covariances. To first order, with x = (u, v, 1) in a camera's plane, E =
/// [t]R and the errors w of the rotation (camera 2) and b of the direction (its
/// tangent basis B), a match has
///   r = x2 . (t x y),  y = R x1,
///   dr/dw = y x (x2 x t),  dr/db = B^T (y x x2),
///   var r = (noise / focal)^2 (|(E x1)_uv|^2 + |(E^T x2)_uv|^2),
/// and the covariance is (sum J^T J / var r + prior)^-1; the prior of 0.3 rad
/// bounds what the matches leave open (a pure rotation: the direction).
void AddPoseNoiseOfPoints(const SyntheticOptions& options,
                          SyntheticScene* synthetic);

/// SyntheticOptions::wrong_direction_share. A greater share replaces the same
/// directions, and more.
void DrawWrongDirections(const SyntheticOptions& options, Scene* scene);
/// The same for SyntheticOptions::wrong_pose_share.
void DrawWrongPoses(const SyntheticOptions& options, Scene* scene);

}  // namespace lowlap
