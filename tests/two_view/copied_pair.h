#pragma once

#include <functional>

#include "lowlap/scene/relative_pose.h"
#include "tests/matching/pattern_view.h"

namespace lowlap::testing {

// From one door of a corridor to the next.
inline Vec3 Step() { return {0, 0, 2.5}; }

/// A point that only the second view shows.
struct Copy {
  Vec3 point;
  PointDescriptor descriptor;
};
using CopyOf =
    std::function<Copy(const Vec3&, const PointDescriptor&, Random*)>;

inline Copy Door(const Vec3& point, const PointDescriptor& look,
                 Random* random) {
  return {point + Step(), Resembling(look, random)};
}

inline Copy Anything(const Vec3& point, const PointDescriptor& /*look*/,
                     Random* random) {
  return {point + Step(), RandomDescriptor(random)};
}

/// Two views of 80 points, and of a copy of each, as they are matched.
struct CopiedPair {
  PatternView view1, view2;
  RelativePose pose;

  explicit CopiedPair(const CopyOf& copy_of,
                      const RigidTransform& cam2_from_cam1 =
                          {RotationFromAngleAxis({0.02, -0.1, 0.01}),
                           Vec3(0.5, 0, -0.6)},
                      const Vec3& low = {-1, -1, 3},
                      const Vec3& high = {1, 1, 6}) {
    pose.rotation = cam2_from_cam1.rotation;
    pose.direction = cam2_from_cam1.translation.normalized();
    pose.point_threshold_px = 1;
    Random random(1);
    for (PatternView* view : {&view1, &view2}) view->features.focal_px = 1000;
    for (FeatureIndex n = 0; n < 80; ++n) {
      const Vec3 point = UniformVec3(random, low, high);
      const PointDescriptor look = RandomDescriptor(&random);
      const Copy copy = copy_of(point, look, &random);
      view1.Add(point, Resembling(look, &random), 1);
      view2.Add(cam2_from_cam1 * point, Resembling(look, &random), 1);
      view2.Add(cam2_from_cam1 * copy.point, copy.descriptor, 1);
      pose.point_inliers.push_back({n, 2 * n});
    }
  }
};

}  // namespace lowlap::testing
