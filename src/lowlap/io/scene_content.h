#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// The kinds of things that a scene consists of, as far as files differ in what
/// they hold of them.
enum class SceneContent {
  kRootPath,     // the image folder
  kNames,        // file names of views
  kIntrinsics,   // focal lengths
  kFrames,       // image sizes and principal points
  kDistortions,  // of intrinsics that have one
  kGivenIntrinsics,
  kPoses,
  kSharedPoses,  // that several views have one pose
  kCenterCovariances,
  kCenterPriors,
  kKeypoints,
  kKeypointShapes,  // covariances of key points
  kSegments,
  kSegmentDeviations,  // other than that of a segment of which it is not known
  kRepeatedFeatures,
  kRelativePoses,
  kUnrelatedPairs,
  kPoseEvidence,  // NFA and threshold of relative poses
  kPoseWeaknesses,
  kPoseCovariances,  // of relative poses
  kAlternatives,     // of relative poses
  kPointMatches,     // inliers of relative poses
  kLineMatches,
  kPointTracks,
  kLineTracks,
  kRatios,
  kPoints,        // triangulated
  kObservations,  // of these
  kLines,         // triangulated
  kLineObservations,
  kCoplanarPairs,
  kControlPoints,
};

using SceneContents = std::set<SceneContent>;

/// A kind, what a person calls several of it, and how many a scene has.
struct ContentKind {
  SceneContent content;
  std::string name;
  std::size_t (*count)(const Scene& scene);
};

/// Every kind, once, in the order in which lists name them.
const std::vector<ContentKind>& ContentKinds();

SceneContents AllContents();

/// "names, poses, points"; "everything" for all of them.
std::string DescribeContents(const SceneContents& contents);

/// "812 lines, 34 ratios": what a scene has beyond `contents`. Empty if that is
/// nothing.
std::string DescribeLoss(const Scene& scene, const SceneContents& contents);

}  // namespace lowlap
