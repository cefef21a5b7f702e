#pragma once

#include <vector>

#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "tests/matching/pattern_view.h"
#include "tests/support/random_vectors.h"

namespace lowlap::testing {

inline constexpr int kColumns = 9, kRows = 7, kMotif = 5;
inline constexpr int kInPattern = kColumns * kRows * kMotif;

inline RigidTransform SideStep() {
  return {RotationFromAngleAxis({0.02, -0.1, 0.01}), Vec3(0.9, 0.1, 0.2)};
}

/// Two views of a wall with a pattern and of `num_others` points before it, at
/// least `least_depth` deep in the room, each of which is matched.
struct TiledPair {
  PatternView view1, view2;
  RepeatedPattern repeats1, repeats2;
  RigidTransform cam2_from_cam1;
  std::vector<FeatureMatch> matches;

  explicit TiledPair(int num_others, const RigidTransform& motion = SideStep(),
                     double least_depth = 2.5)
      : cam2_from_cam1(motion) {
    const RigidTransform cam1 = ObliqueCamera();
    const RigidTransform cam2 = cam2_from_cam1 * cam1;
    Random random(1);
    for (PatternView* view : {&view1, &view2}) {
      view->features.focal_px = 1000;
      Random motif(2);
      AddPattern(kColumns, kRows, kMotif, 0.3, view == &view1 ? cam1 : cam2,
                 &motif, view);
    }
    for (int n = 0; n < num_others; ++n) {
      const Vec3 point =
          UniformVec3(random, {-2, -1.5, least_depth}, {2, 1.5, 5});
      const PointDescriptor descriptor = RandomDescriptor(&random);
      view1.Add(cam1 * point, descriptor, 2);
      view2.Add(cam2 * point, descriptor, 2);
    }
    for (int n = 0; n < kInPattern + num_others; ++n) {
      const auto index = static_cast<FeatureIndex>(n);
      matches.push_back({index, index});
    }
    repeats1 = RepeatedPattern::Find(view1.View());
    repeats2 = RepeatedPattern::Find(view2.View());
  }

  TwoViewInput Input() const {
    TwoViewInput input;
    input.views = {0, 1};
    input.features1 = &view1.features;
    input.features2 = &view2.features;
    input.point_matches = matches;
    input.repeats1 = &repeats1;
    input.repeats2 = &repeats2;
    input.image_size1_px = input.image_size2_px = Vec2(1600, 1200);
    return input;
  }

  RelativePose TruePose() const {
    RelativePose pose;
    pose.views = {0, 1};
    pose.rotation = cam2_from_cam1.rotation;
    pose.direction = cam2_from_cam1.translation.normalized();
    pose.point_threshold_px = 1;
    return pose;
  }
};

/// Each tile of a TiledPair with its neighbour, and the others with themselves.
inline std::vector<FeatureMatch> MatchesOfNeighbours(int num_others) {
  std::vector<FeatureMatch> matches;
  const auto num = static_cast<FeatureIndex>(kInPattern + num_others);
  for (FeatureIndex n = 0; n < num; ++n) {
    const bool is_in_pattern = n < kInPattern;
    if (is_in_pattern && n % kColumns + 1 == kColumns) continue;
    matches.push_back({n, is_in_pattern ? n + 1 : n});
  }
  return matches;
}

}  // namespace lowlap::testing
