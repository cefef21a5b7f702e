#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "support/random_vectors.h"

namespace lowlap::testing {

/// What a detector might find of a wall with a pattern that repeats and of
/// points that do not.
struct PatternView {
  std::vector<Keypoint> keypoints;
  std::vector<PointDescriptor> descriptors;
  NormalizedFeatures features;

  PointView View() const { return {keypoints, descriptors, features}; }

  void Add(const Vec3& x, const PointDescriptor& descriptor, double scale_px) {
    Keypoint keypoint;
    keypoint.position_px = features.focal_px * x.hnormalized();
    keypoint.scale_px = scale_px;
    keypoints.push_back(keypoint);
    descriptors.push_back(descriptor);
    features.points.push_back(Vec3(x / x.z()));
  }
};

inline PointDescriptor RandomDescriptor(Random* random) {
  PointDescriptor descriptor;
  for (auto& value : descriptor) {
    value = static_cast<std::uint8_t>(random->Index(90));
  }
  return descriptor;
}

/// The same but for noise of a few units in each element.
inline PointDescriptor Resembling(const PointDescriptor& descriptor,
                                  Random* random) {
  PointDescriptor result = descriptor;
  for (auto& value : result) {
    value = static_cast<std::uint8_t>(
        std::clamp(std::lround(value + random->Gaussian(3)), 0L, 255L));
  }
  return result;
}

/// A camera that looks at the wall z = 5 at an angle.
inline RigidTransform ObliqueCamera() {
  return {RotationFromAngleAxis({0.2, 0.5, 0.05}), Vec3(-1.8, 0.4, 0.3)};
}

/// `motif` points in each of columns x rows cells of 0.5 m on the wall z = 5,
/// with `noise_px`.
inline void AddPattern(int columns, int rows, int motif, double noise_px,
                       const RigidTransform& cam_from_world, Random* random,
                       PatternView* view) {
  for (int m = 0; m < motif; ++m) {
    const PointDescriptor descriptor = RandomDescriptor(random);
    const Vec2 inner = UniformVec2(*random, {0, 0}, {0.5, 0.5});
    for (int cell = 0; cell < columns * rows; ++cell) {
      const Vec3 point(inner.x() + 0.5 * (cell % columns - columns / 2),
                       inner.y() + 0.5 * (cell / columns - rows / 2), 5);
      Vec3 x = cam_from_world * point;
      x /= x.z();
      x.x() += random->Gaussian(noise_px / view->features.focal_px);
      x.y() += random->Gaussian(noise_px / view->features.focal_px);
      view->Add(x, Resembling(descriptor, random), 2);
    }
  }
}

/// Points anywhere in the image, each like no other.
inline void AddOthers(int count, Random* random, PatternView* view) {
  for (int n = 0; n < count; ++n) {
    const PointDescriptor descriptor = RandomDescriptor(random);
    view->Add(UniformVec2(*random, {-0.6, -0.45}, {0.6, 0.45}).homogeneous(),
              descriptor, 2);
  }
}

}  // namespace lowlap::testing
